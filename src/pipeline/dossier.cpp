#include "pipeline/dossier.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "curvetet/formats.h"

namespace curvetet {

namespace {

namespace fs = std::filesystem;

constexpr const char *kSummary = "summary.txt", *kReport = "report.json", *kFaces = "faces.brep", *kSpot = "spot.vtu",
                     *kReplay = "replay.bin";
constexpr std::size_t kMostErrors = 8;

/// As a shell takes it for one word.
std::string quoted(const std::string& path) {
  constexpr std::string_view kPlain = "-_./+=:,@%";
  const bool plain = std::all_of(path.begin(), path.end(), [&](unsigned char c) {
    return std::isalnum(c) != 0 || kPlain.find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return path;
  std::string inner;
  for (const char c : path) {
    if (c == '\'')
      inner += "'\\''";
    else
      inner += c;
  }
  return fmt::format("'{}'", inner);
}

class Dossier {
 public:
  Dossier(const FailedRun& run, const std::string& folder) : run_(run), folder_(folder) {}

  Status write() {
    std::error_code code;
    const bool is_new = !fs::exists(folder_, code);
    fs::create_directories(folder_, code);
    if (code) return no_folder(code.message());
    write_report();
    write_faces();
    write_spot();
    write_replay();
    const Status written = write_file_atomically(path(kSummary), summary());
    if (!written && !failure_) failure_ = written.error();
    if (!failure_) return Done{};
    if (is_new) fs::remove(folder_, code);  // only if it is empty
    return *failure_;
  }

 private:
  Error no_folder(const std::string& why) const {
    return {ErrorCode::output_unwritable,
            folder_ + " cannot be made a folder: " + why,
            {},
            {},
            "check the place, its permissions and the free space"};
  }

  std::string path(const char* file) const { return (fs::path(folder_) / file).string(); }

  /// A file that cannot be written does not keep the others, which may be smaller, from being tried.
  void keep(const char* file, const std::string& what, const Status& written) {
    if (written) {
      kept_ += fmt::format("  {:<12} {}\n", file, what);
      return;
    }
    if (!failure_) failure_ = written.error();
    leave_out(file, written.error().message);
  }

  void leave_out(const char* file, const std::string& why) {
    std::error_code ignored;
    fs::remove(path(file), ignored);
    left_out_ += fmt::format("  {:<12} {}\n", file, why);
  }

  const Error& error() const { return run_.report.errors.front(); }
  const std::string& unit() const { return run_.report.unit; }

  void write_report() {
    keep(kReport, "the report of the run", write_file_atomically(path(kReport), run_.report.to_json()));
  }

  void write_faces() {
    if (error().entities.empty()) return leave_out(kFaces, "the error names no part of the body");
    const Result<std::string> brep = run_.parts(error().entities);
    if (!brep) return leave_out(kFaces, brep.error().message);
    keep(kFaces, "these parts of the input, in the coordinates in which it was read",
         write_file_atomically(path(kFaces), brep.value()));
  }

  void write_spot() {
    if (!run_.spot) return leave_out(kSpot, "no surface mesh failed");
    if (run_.spot->points.empty()) return leave_out(kSpot, "the run ended before there were surface triangles");
    keep(kSpot, fmt::format("surface triangles of these faces, and of others near the place, in {}", unit()),
         write_mesh(*run_.spot, path(kSpot), {MeshFormat::vtu}));
  }

  void write_replay() {
    if (!run_.state) return leave_out(kReplay, run_.no_state);
    keep(kReplay, "the state of the run before its last attempt", write_state(*run_.state, path(kReplay)));
  }

  std::string error_lines(const Error& error) const {
    std::string text = fmt::format("{}: {}\n", name(error.code), error.message);
    for (const std::string& entity : error.entities) {
      const auto words = run_.in_words.find(entity);
      text += fmt::format("  {}\n", words == run_.in_words.end() ? entity : words->second);
    }
    if (error.where)
      text += fmt::format("  at ({:.6g}, {:.6g}, {:.6g}){}{}\n", error.where->x, error.where->y, error.where->z,
                          unit().empty() ? "" : " ", unit());
    if (!error.hint.empty()) text += fmt::format("  what to do: {}\n", error.hint);
    return text;
  }

  std::string summary() const {
    const std::vector<Error>& errors = run_.report.errors;
    std::string text = fmt::format("curvetet {} made no valid mesh of {}\n", run_.report.version, run_.report.input);
    for (std::size_t i = 0; i < std::min(errors.size(), kMostErrors); ++i)
      text += fmt::format("\n{}", error_lines(errors[i]));
    if (errors.size() > kMostErrors)
      text += fmt::format("\nand {} more: see {}\n", errors.size() - kMostErrors, kReport);
    text += fmt::format("\nIn this folder:\n{}", kept_);
    if (!left_out_.empty()) text += fmt::format("\nLeft out:\n{}", left_out_);
    if (run_.state) text += fmt::format("\nTo make the attempt again:\n  curvetet replay {}\n", quoted(path(kReplay)));
    return text;
  }

  const FailedRun& run_;
  std::string folder_;
  std::string kept_, left_out_;
  std::optional<Error> failure_;  ///< the first that kept a file from being written
};

}  // namespace

Status write_dossier(const FailedRun& run, const std::string& folder) { return Dossier(run, folder).write(); }

}  // namespace curvetet
