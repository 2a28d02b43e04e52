// Python runs signal handlers on its main thread only, between instructions; so the mesher works on another thread and
// the caller's thread wakes up often enough to look. Calling back from the mesher's threads was rejected: handlers that
// raise would then have nowhere to raise to.
#include "run.h"

#include <pybind11/stl.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "options.h"

namespace py = pybind11;

namespace curvetet::python {

namespace {

constexpr std::chrono::milliseconds kWake{50};

const char* level_name(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return "debug";
    case LogLevel::info:
      return "info";
    case LogLevel::warning:
      return "warning";
    case LogLevel::error:
      return "error";
  }
  return "info";
}

py::dict parse_report(const Report& report) {
  return py::module_::import("json").attr("loads")(report.to_json()).cast<py::dict>();
}

/// What the mesher's threads leave for the caller's.
class Mailbox {
 public:
  void attach(Context& context) {
    context.on_progress = [this](std::string_view stage, double fraction) {
      const std::lock_guard lock(mutex_);
      progress_.emplace(std::string(stage), fraction);
    };
    context.on_log = [this](LogLevel level, std::string_view message) {
      const std::lock_guard lock(mutex_);
      messages_.emplace_back(level, std::string(message));
    };
  }

  void finish() {
    const std::lock_guard lock(mutex_);
    done_ = true;
    wake_.notify_all();
  }

  /// Waits a little; true once the run is over.
  bool wait() {
    std::unique_lock lock(mutex_);
    return wake_.wait_for(lock, kWake, [this] { return done_; });
  }

  /// Calls back with what has come; with the interpreter's lock.
  void deliver(const py::object& progress, const py::object& log) {
    std::optional<std::pair<std::string, double>> last;
    std::deque<std::pair<LogLevel, std::string>> messages;
    {
      const std::lock_guard lock(mutex_);
      last.swap(progress_);
      messages.swap(messages_);
    }
    if (!log.is_none())
      for (const auto& [level, message] : messages) log(level_name(level), message);
    if (!progress.is_none() && last) progress(last->first, last->second);
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::optional<std::pair<std::string, double>> progress_;
  std::deque<std::pair<LogLevel, std::string>> messages_;
};

/// The first thing that Python code raised; it ends the run.
class Raised {
 public:
  explicit Raised(Context& context) : context_(context) {}
  void keep(py::error_already_set error) {
    if (!first_) first_.emplace(std::move(error));
    context_.cancel();
  }
  void rethrow() {
    if (first_) throw std::move(*first_);
  }

 private:
  Context& context_;
  std::optional<py::error_already_set> first_;
};

class MeshRun {
 public:
  MeshRun(const std::filesystem::path& path, const py::dict& options)
      : raised_(context_),
        path_(path.string()),
        options_(options_from(options, [this](py::error_already_set error) { raised_.keep(std::move(error)); })) {
    context_.memory_limit = options_.memory_limit;
    mailbox_.attach(context_);
  }

  Result<MeshOutput> operator()(const py::object& progress, const py::object& log) {
    std::thread mesher([this] { work(); });
    for (bool done = false; !done;) {
      {
        const py::gil_scoped_release others_run;
        done = mailbox_.wait();
      }
      look_around(progress, log);
    }
    {
      const py::gil_scoped_release others_run;
      mesher.join();
    }
    raised_.rethrow();
    if (failure_) std::rethrow_exception(failure_);
    return std::move(*made_);
  }

  const Report& report_of_failure() const { return report_; }

 private:
  void work() {
    try {
      made_.emplace(mesh({path_}, options_, context_, &report_));
    } catch (...) {
      failure_ = std::current_exception();
    }
    mailbox_.finish();
  }

  void look_around(const py::object& progress, const py::object& log) {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!context_.cancelled()) mailbox_.deliver(progress, log);
    } catch (py::error_already_set& error) {
      raised_.keep(std::move(error));
    }
  }

  Context context_;
  Mailbox mailbox_;
  Raised raised_;
  std::string path_;
  Options options_;
  Report report_;
  std::optional<Result<MeshOutput>> made_;
  std::exception_ptr failure_;
};

}  // namespace

void raise(const Error& error, const py::dict& report) {
  const py::object where =
      error.where ? py::object(py::make_tuple(error.where->x, error.where->y, error.where->z)) : py::none();
  const py::object type = py::module_::import("curvetet").attr("Error");
  const py::object instance =
      type(name(error.code), exit_code(error.code), error.message, error.entities, where, error.hint, report);
  PyErr_SetObject(type.ptr(), instance.ptr());
  throw py::error_already_set();
}

MadeMesh run_mesh(const std::filesystem::path& path, const py::dict& options, bool keep_invalid,
                  const py::object& progress, const py::object& log) {
  MeshRun run(path, options);
  Result<MeshOutput> made = run(progress, log);
  if (!made) raise(made.error(), parse_report(run.report_of_failure()));
  const py::dict report = parse_report(made.value().report);
  if (!made.value().report.valid && !keep_invalid) {
    raise({ErrorCode::invalid_mesh,
           "the mesh did not pass its final check",
           {},
           {},
           "keep_invalid=True returns it all the same"},
          report);
  }
  return {std::move(made.value().mesh), report};
}

}  // namespace curvetet::python
