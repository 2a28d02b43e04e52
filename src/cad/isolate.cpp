// The helper's output is thrown away, and it is polled, so that a cancel takes effect within milliseconds. It limits
// its own memory and processor time, since posix_spawn cannot. A variable in its environment keeps a program that was
// started by mistake from starting helpers too.
#include "cad/isolate.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>
#include <vector>

#include "base/child_program.h"
#include "cad/guard.h"
#include "cad/heal.h"
#include "cad/parts_of_body.h"
#include "cad/read.h"
#include "cad/transfer.h"

namespace curvetet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kHelperVariable = "CURVETET_CAD_HELPER";
/// A busy machine must not fail a body that an idle one reads: processor time counts, the clock only stops what sleeps.
constexpr double kClockFactor = 4;
constexpr const char* kHelperFlag = "--cad-helper";

// How the helper is told of Joining.
constexpr const char *kAutomatic = "auto", *kStrict = "strict", *kOff = "off", *kSplit = "split";

std::string word_of(const Joining& joining) {
  if (joining.conformal == Conformal::off) return kOff;
  const std::string word = joining.conformal == Conformal::strict ? kStrict : kAutomatic;
  return joining.overlaps == Overlaps::split ? word + "," + kSplit : word;
}

std::string list_of(const std::vector<std::uint32_t>& ids) {
  std::string list;
  for (const std::uint32_t id : ids) list += std::to_string(id) + ',';
  return list;
}

std::vector<std::uint32_t> ids_of(const std::string& list) {
  std::vector<std::uint32_t> ids;
  std::istringstream in(list);
  for (std::string id; std::getline(in, id, ',');)
    ids.push_back(static_cast<std::uint32_t>(std::strtoul(id.c_str(), nullptr, 10)));
  return ids;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += word + ',';
  return list;
}

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  return words;
}

Joining joining_of(const std::string& word) {
  Joining joining;
  if (word == kOff) joining.conformal = Conformal::off;
  if (word.rfind(kStrict, 0) == 0) joining.conformal = Conformal::strict;
  if (word.find(kSplit) != std::string::npos) joining.overlaps = Overlaps::split;
  return joining;
}

/// A folder of our own that vanishes with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code code;
    std::string pattern = (std::filesystem::temp_directory_path(code) / "curvetet-XXXXXX").string();
    if (!code && mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code code;
    if (!path_.empty()) std::filesystem::remove_all(path_, code);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string seconds_text(double seconds) { return std::to_string(static_cast<long>(std::llround(seconds))) + " s"; }

Error crashed(const std::string& path, int signal_number) {
  std::string how = "ended before it was done";
  if (signal_number != 0) how = "crashed (" + std::string(strsignal(signal_number)) + ")";
  return Error{ErrorCode::reader_crashed,
               "the CAD kernel " + how + " while reading " + path,
               {},
               {},
               "export the body again, from another CAD system or as another format"};
}

Error timed_out(const std::string& path, double seconds) {
  return Error{ErrorCode::reader_failed,
               "the CAD kernel did not end reading " + path + " within " + seconds_text(seconds),
               {},
               {},
               "a time limit for the run longer than that lets it read on; or export the body again"};
}

void limit(int resource, rlim_t value) {
  rlimit limits{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limits) != 0) return;
  limits.rlim_cur = limits.rlim_max == RLIM_INFINITY ? value : std::min(value, limits.rlim_max);
  setrlimit(static_cast<__rlimit_resource_t>(resource), &limits);
}

void limit_this_process(std::size_t memory, double seconds) {
  limit(RLIMIT_CORE, 0);
#ifndef __SANITIZE_ADDRESS__  // the sanitizer reserves terabytes of addresses
  if (memory > 0) limit(RLIMIT_AS, static_cast<rlim_t>(memory));
#else
  (void)memory;
#endif
  if (seconds > 0) limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(seconds)) + 1);
}

}  // namespace

std::optional<std::string> find_helper(const LoadOptions& options) {
  if (!options.helper.empty()) return options.helper;
  std::error_code code;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", code);
  if (code) return std::nullopt;
  if (self.filename() == "curvetet") return self.string();
  const std::filesystem::path beside = self.parent_path() / "curvetet";
  if (std::filesystem::is_regular_file(beside, code)) return beside.string();
  return std::nullopt;
}

Result<CadBody> read_isolated(const std::string& path, const std::string& helper, const LoadOptions& options,
                              const std::vector<std::string>& parts, Context& context) {
  if (std::getenv(kHelperVariable) != nullptr) {
    return Error{ErrorCode::bad_option,
                 "a helper process was asked to start a helper: this program does not serve as one",
                 {},
                 {},
                 "set the helper to the curvetet program, or read without isolation"};
  }
  const TemporaryFolder folder;
  if (folder.path().empty()) return Error{ErrorCode::output_unwritable, "cannot make a temporary folder"};
  const std::string out_path = folder.path() + "/shape.bin";
  const double allowed = options.isolate_time_limit;
  ChildProgram child(
      helper,
      {helper, kHelperFlag, path, out_path, options.input_unit, std::to_string(options.isolate_memory_limit),
       std::to_string(allowed), word_of(options.joining), list_of(options.suspects),
       exact_text(options.min_feature.value), options.min_feature.unit, list_of(parts)},
      "/dev/null", {std::string(kHelperVariable) + "=1", end_with_parent_variable()});
  if (!child.started()) return Error{ErrorCode::bad_option, "cannot start the helper program " + helper};
  const auto start = Clock::now();
  auto pause = std::chrono::milliseconds(1);
  while (!child.poll()) {
    if (context.should_stop()) return context.stop_error("load");
    if (allowed > 0 && std::chrono::duration<double>(Clock::now() - start).count() > kClockFactor * allowed) {
      return timed_out(path, allowed);
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(16));
  }
  if (context.should_stop()) return context.stop_error("load");
  if (child.signal() == SIGXCPU) return timed_out(path, allowed);
  if (!transfer_announced(out_path) && child.signal() == 0) {
    return Error{ErrorCode::bad_option,
                 helper + " does not serve as helper of this version",
                 {},
                 {},
                 "set the helper to the curvetet program, or read without isolation"};
  }
  if (child.signal() != 0) return crashed(path, child.signal());
  Result<CadBody> body = read_transfer(out_path);
  if (!body && body.error().code == ErrorCode::reader_crashed) return crashed(path, 0);
  return body;
}

int run_cad_helper(int argc, char** argv) {
  constexpr int kUsage = 2, kUnwritable = 3;
  if (argc != 12 || std::string(argv[1]) != kHelperFlag) return kUsage;
  const std::string path = argv[2], out_path = argv[3], unit = argv[4];
  end_with_parent();
  limit_this_process(std::strtoull(argv[5], nullptr, 10), std::strtod(argv[6], nullptr));
  if (!announce_transfer(out_path)) return kUnwritable;
  Result<CadBody> body = read_body(path, unit);
  if (!body) return write_transfer(body.error(), out_path) ? 0 : kUnwritable;
  if (const std::vector<std::string> parts = words_of(argv[11]); !parts.empty()) {
    const Result<CadBody> some = parts_of_body(body.value(), parts, path);
    return (some ? write_transfer(some.value(), out_path) : write_transfer(some.error(), out_path)) ? 0 : kUnwritable;
  }
  const Length min_feature{std::strtod(argv[9], nullptr), argv[10]};
  const Result<Model> model = heal_and_convert(body.value(), path, {joining_of(argv[7]), min_feature, ids_of(argv[8])});
  const bool written = model ? write_transfer(body.value(), out_path) : write_transfer(model.error(), out_path);
  return written ? 0 : kUnwritable;
}

}  // namespace curvetet
