// `curvetet batch`: many bodies, each meshed by a `curvetet mesh` of its own, so that nothing one of them does touches
// another or the batch. One thread starts, watches and ends the programs.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "base/child_program.h"
#include "batch_bodies.h"
#include "batch_results.h"
#include "commands.h"
#include "curvetet/curvetet.h"
#include "curvetet/formats.h"
#include "own_program.h"
#include "terminal.h"

namespace curvetet::cli {

namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// A program keeps its time limit itself, and writes its report; one that does not is killed this much later.
constexpr double kGrace = 1.1, kGraceSeconds = 5;
/// Seconds that programs get to end by themselves when the batch is cancelled.
constexpr double kPatience = 0.7;
constexpr std::chrono::milliseconds kPause(10);
constexpr const char* kUnwritable = "output_unwritable";
constexpr int kSomeFailed = 5;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string duration_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  return seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60) : fmt::format("{:.1f} h", seconds / 3600);
}

struct Running {
  BatchRow row;
  Clock::time_point begin;
  std::string log;
  std::unique_ptr<ChildProgram> child;
};

class Batch {
 public:
  explicit Batch(const BatchCommand& command)
      : command_(command),
        jobs_(command.jobs > 0 ? static_cast<std::size_t>(command.jobs)
                               : std::max<std::size_t>(1, std::thread::hardware_concurrency())),
        on_terminal_(isatty(STDERR_FILENO) == 1) {}

  int run() {
    auto bodies = find_bodies(command_.source);
    if (!bodies) return show_error(bodies.error());
    bodies_ = std::move(bodies.value());
    for (const BatchBody& body : bodies_) {
      if (const auto wrong = wrong_batch_options(body.options, command_.format))
        return show_error({ErrorCode::bad_option, body.name + ": " + *wrong, {}, {}, "options are separated by tabs"});
    }
    if (const Status opened = results_.open(command_.out, all_options(), command_.restart); !opened)
      return show_error(opened.error());
    results_.keep_only(bodies_);
    const CancelOnSignal signals(context_);
    for (const BatchBody& body : bodies_)
      if (!results_.is_done(body)) waiting_.push_back(&body);
    say_what_is_done_already();
    std::reverse(waiting_.begin(), waiting_.end());  // taken from the end
    const Status status = work();
    clear_bar();
    if (!status) return show_error(status.error());
    return finish();
  }

 private:
  /// What decides a body's result, and so must be the same when a batch goes on.
  std::vector<std::string> all_options() const {
    std::vector<std::string> options = command_.mesh_options;
    options.push_back(fmt::format("format {}", command_.format));
    options.push_back(fmt::format("time limit {}", command_.time_limit));
    options.push_back(fmt::format("memory limit {}", command_.memory_limit));
    return options;
  }

  void say_what_is_done_already() const {
    const std::size_t done = bodies_.size() - waiting_.size();
    if (done > 0 && !command_.quiet)
      fmt::print(stderr, "curvetet: {} of {} bodies are done already; {} are left\n", done, bodies_.size(),
                 waiting_.size());
  }

  Status work() {
    begin_ = Clock::now();
    while (!waiting_.empty() || !running_.empty()) {
      if (context_.should_stop()) {
        stop();
        return Done{};
      }
      while (!waiting_.empty() && running_.size() < jobs_) start(*waiting_.back());
      for (std::size_t i = 0; i < running_.size();) {
        if (!has_ended(running_[i])) {
          ++i;
          continue;
        }
        const Running ended = std::move(running_[i]);
        running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
        if (Status kept = keep(ended); !kept) return kept;
      }
      show_bar();
      std::this_thread::sleep_for(kPause);
    }
    return Done{};
  }

  /// What is not finished leaves no trace, and is done when the batch goes on.
  void stop() {
    for (const Running& r : running_) r.child->terminate();
    const auto begin = Clock::now();
    const auto ended = [](Running& r) { return !r.child->started() || r.child->poll(); };
    while (!std::all_of(running_.begin(), running_.end(), ended) && seconds_since(begin) < kPatience)
      std::this_thread::sleep_for(kPause);
    for (Running& r : running_) {
      r.child.reset();
      std::error_code ignored;
      for (const std::string& file : {in_folder(r.row.mesh), in_folder(r.row.report), r.log}) fs::remove(file, ignored);
    }
    running_.clear();
  }

  std::string in_folder(const std::string& name) const { return (fs::path(command_.out) / name).string(); }

  void start(const BatchBody& body) {
    waiting_.pop_back();
    Running r;
    r.row.body = body.name;
    r.row.options = body.options;
    r.row.mesh = body.stem + "." + command_.format;
    r.row.report = body.stem + ".json";
    r.log = in_folder(body.stem + ".log");
    for (const std::string& old : {in_folder(r.row.mesh), in_folder(r.row.report)}) {
      std::error_code ignored;
      fs::remove(old, ignored);
    }
    std::vector<std::string> arguments{"curvetet",
                                       "mesh",
                                       body.path,
                                       "-o",
                                       in_folder(r.row.mesh),
                                       "--report",
                                       in_folder(r.row.report),
                                       "--quiet",
                                       "--time-limit",
                                       fmt::format("{}", command_.time_limit)};
    if (!command_.dossiers.empty()) {
      arguments.emplace_back("--dossier");
      arguments.push_back((fs::path(command_.dossiers) / body.stem).string());
    }
    if (command_.memory_limit > 0) {
      arguments.emplace_back("--memory-limit");
      arguments.push_back(std::to_string(command_.memory_limit));
    }
    if (!names_threads(command_.mesh_options) && !names_threads(body.options)) {
      arguments.emplace_back("--threads");
      arguments.push_back(std::to_string(threads_of_a_job()));
    }
    for (const auto* options : {&command_.mesh_options, &body.options})
      arguments.insert(arguments.end(), options->begin(), options->end());
    r.begin = Clock::now();
    r.child = std::make_unique<ChildProgram>(own_program(), arguments, r.log,
                                             std::vector<std::string>{end_with_parent_variable()});
    running_.push_back(std::move(r));
  }

  static bool names_threads(const std::vector<std::string>& options) {
    return std::any_of(options.begin(), options.end(), [](const std::string& o) { return o.starts_with("--threads"); });
  }

  /// The cores are shared out: threads that wait for cores hold each other up.
  std::size_t threads_of_a_job() const { return std::max<std::size_t>(1, std::thread::hardware_concurrency() / jobs_); }

  bool has_ended(Running& r) const {
    if (!r.child->started() || r.child->poll()) return true;
    if (seconds_since(r.begin) < kGrace * command_.time_limit + kGraceSeconds) return false;
    r.child->kill();
    r.row.cause = "did not end in time";
    return true;
  }

  Status keep(const Running& ended) {
    BatchRow row = ended.row;
    row.seconds = seconds_since(ended.begin);
    if (!ended.child->started())
      return Error{ErrorCode::internal, "the program cannot start itself for " + row.body, {}, {}, ""};
    row.exit = ended.child->exit_code();
    std::error_code ignored;
    row.valid = row.exit == 0 && fs::is_regular_file(in_folder(row.mesh), ignored);
    describe(ended, row);
    if (row.exit != 0 && !fs::exists(in_folder(row.report), ignored)) {
      if (Status room = probe(); !room) return room;
    }
    // A full disk is not the body's fault: nothing more would come of the batch.
    if (row.cause == kUnwritable)
      return Error{
          ErrorCode::output_unwritable, row.message, {}, {}, "make room, and start the batch again: it goes on"};
    if (row.valid) fs::remove(ended.log, ignored);
    if (Status added = results_.add(row); !added) return added;
    ++finished_;
    say(row);
    return Done{};
  }

  /// A report may be missing since nothing can be written any more.
  Status probe() const {
    constexpr std::size_t kBytes = 65536;
    const std::string path = in_folder(".probe");
    Status written = write_file_atomically(path, std::string(kBytes, ' '));
    std::error_code ignored;
    fs::remove(path, ignored);
    return written;
  }

  void describe(const Running& ended, BatchRow& row) const {
    const std::string why = row.cause;  // set if it was killed
    read_report(in_folder(row.report), row);
    if (row.valid) row.cause.clear();
    if (!why.empty()) row.cause = why;
    if (row.valid || !row.cause.empty()) return;
    if (const int signal = ended.child->signal(); signal != 0)
      row.cause = fmt::format("killed by signal {} ({})", signal, strsignal(signal));
    else
      row.cause = fmt::format("exit code {} without a report", row.exit);
  }

  void say(const BatchRow& row) {
    if (command_.quiet) return;
    clear_bar();
    if (row.valid) {
      if (!on_terminal_) fmt::print(stderr, "valid   {:7.1f} s  {}\n", row.seconds, row.body);
      return;
    }
    fmt::print(stderr, "failed  {:7.1f} s  {}: {}{}{}\n", row.seconds, row.body, row.cause,
               row.message.empty() ? "" : ": ", row.message);
  }

  /// The time left goes by what the bodies took so far in this run.
  std::string time_left() const {
    if (finished_ == 0) return "";
    const double each = seconds_since(begin_) / static_cast<double>(finished_);
    return ", about " + duration_text(each * static_cast<double>(waiting_.size() + running_.size())) + " left";
  }

  void show_bar() {
    if (!on_terminal_ || command_.quiet || seconds_since(last_shown_) < 0.2) return;
    last_shown_ = Clock::now();
    const std::size_t done = bodies_.size() - waiting_.size() - running_.size();
    constexpr std::size_t kWidth = 30;
    const std::size_t failed = results_.rows().size() - results_.valid();
    fmt::print(stderr, "\r[{:-<{}}] {} of {}, {} failed{}\x1b[K", std::string(kWidth * done / bodies_.size(), '#'),
               kWidth, done, bodies_.size(), failed, time_left());
    std::fflush(stderr);
    bar_shown_ = true;
  }

  void clear_bar() {
    if (bar_shown_) fmt::print(stderr, "\r\x1b[K");
    bar_shown_ = false;
  }

  int finish() {
    if (const Status written = results_.write_summary(bodies_.size()); !written) return show_error(written.error());
    const std::size_t done = results_.rows().size(), valid = results_.valid();
    fmt::print("valid {} of {} ({:.1f} %)\n", valid, done,
               100.0 * static_cast<double>(valid) / static_cast<double>(std::max<std::size_t>(done, 1)));
    const auto causes = results_.causes();
    std::vector<std::pair<std::size_t, std::string>> order;
    order.reserve(causes.size());
    for (const auto& [cause, count] : causes) order.emplace_back(count, cause);
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    for (const auto& [count, cause] : order) fmt::print("{:7}  {}\n", count, cause);
    if (context_.should_stop())
      return show_error({ErrorCode::cancelled,
                         fmt::format("cancelled; {} of {} bodies are done", done, bodies_.size()),
                         {},
                         {},
                         "the same command goes on"});
    return valid == done ? 0 : kSomeFailed;
  }

  const BatchCommand& command_;
  std::size_t jobs_;
  bool on_terminal_;
  Context context_;
  BatchResults results_;
  std::vector<BatchBody> bodies_;
  std::vector<const BatchBody*> waiting_;
  std::vector<Running> running_;
  Clock::time_point begin_, last_shown_;
  std::size_t finished_ = 0;  ///< in this run
  bool bar_shown_ = false;
};

}  // namespace

int run_batch(const BatchCommand& command) { return Batch(command).run(); }

}  // namespace curvetet::cli
