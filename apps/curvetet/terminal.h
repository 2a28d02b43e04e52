// What the command line shows while it works: progress, log lines, errors in words; and what Ctrl-C does.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "curvetet/context.h"
#include "curvetet/error.h"

namespace curvetet::cli {

enum class Volume { quiet, normal, verbose };

/// Shows a run's progress and log on standard error: a bar on a terminal, lines elsewhere. Must outlive the run.
class Terminal {
 public:
  explicit Terminal(Volume volume);
  ~Terminal() { clear_bar(); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Makes the context report here.
  void attach(Context& context);
  /// Takes the bar off the terminal.
  void clear_bar();

 private:
  void show_progress(std::string_view stage, double fraction);
  void show_log(LogLevel level, std::string_view message);

  std::mutex mutex_;  // the sinks may be called from any thread of the run
  Volume volume_;
  bool on_terminal_ = false, bar_shown_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_, last_shown_;
};

/// While it lives, Ctrl-C (and SIGTERM) cancels the context; a second one ends the program at once.
class CancelOnSignal {
 public:
  explicit CancelOnSignal(Context& context);
  ~CancelOnSignal();
  CancelOnSignal(const CancelOnSignal&) = delete;
  CancelOnSignal& operator=(const CancelOnSignal&) = delete;
};

/// An error in words on standard error: what, where, and what to do. Returns the exit code that belongs to it.
int show_error(const Error& error);

}  // namespace curvetet::cli
