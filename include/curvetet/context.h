// What a run is given besides its input: progress, cancel, log, seed, threads, limits. Passed, never global.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "curvetet/error.h"

namespace curvetet {

enum class CheckLevel { cheap, full, paranoid };
enum class LogLevel { debug, info, warning, error };

/// Shared by all stages of one run. Thread-safe: cancel() may be called from any thread, also from a signal handler.
class Context {
 public:
  using ProgressSink = std::function<void(std::string_view stage, double fraction)>;
  using LogSink = std::function<void(LogLevel, std::string_view message)>;

  ProgressSink on_progress;  ///< fraction in [0,1] of the whole run, never falls
  LogSink on_log;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all cores; never more than there are
  CheckLevel check_level = CheckLevel::cheap;
  std::optional<std::chrono::steady_clock::time_point> deadline;
  std::size_t memory_limit = 0;  ///< bytes of our own arrays; 0: none

  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }
  /// Cancelled or out of time: to be asked often (one relaxed load and, where a deadline is set, a clock reading).
  bool should_stop() const { return cancelled() || (deadline && std::chrono::steady_clock::now() > *deadline); }
  /// The error that belongs to should_stop().
  Error stop_error(std::string_view stage) const;

  void log(LogLevel level, std::string_view message) const {
    if (on_log) on_log(level, message);
  }
  /// Reports that a stage begins, which occupies [begin, end] of the run.
  void progress(std::string_view stage, double begin, double end);
  void progress(std::string_view stage, double fraction) { progress(stage, fraction, fraction); }
  /// Reports the share of the running stage that is done. Not to be called from several threads.
  void advance(double share);

 private:
  std::string stage_;
  double stage_begin_ = 0, stage_end_ = 0;
  std::atomic<bool> cancelled_{false};
  double reported_ = 0;
};

/// Calls body(i) for i in [0, n) on the context's threads; the largest first if the caller orders them so. Results must
/// be written to slots by i, so that the outcome does not depend on the number of threads. Exceptions are rethrown.
void parallel_for(const Context& context, std::size_t n, const std::function<void(std::size_t)>& body);

/// The same with the number of the worker that calls, below worker_count(), for scratch arrays that need no content.
void parallel_for(const Context& context, std::size_t n,
                  const std::function<void(std::size_t i, std::size_t worker)>& body);
std::size_t worker_count(const Context& context);  ///< at least 1

}  // namespace curvetet
