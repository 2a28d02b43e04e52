// Threads for work that comes in many short phases, one after the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/context.h"

namespace curvetet {

/// One thread, that of the owner, works through the phases in order; in each the others take blocks of it, too. To
/// start a phase takes less than a microsecond, since they wait for it awake; only if none comes for a while they
/// sleep. Each has a share of the blocks, the same part of every phase, so that what is near in the order of the items
/// stays in the cache of one core; whoever is done with its own takes of others'. They are started with the first phase
/// that has more than one block. Where the machine gives them no time, the owner does all of a phase alone: it waits
/// for those blocks only that others have begun.
///
/// Phases of more than a millisecond have parallel_for(), whose threads are shared by all of the program.
class Team {
 public:
  /// More would only look on: phases have few blocks.
  static constexpr std::size_t kMostThreads = 16;

  explicit Team(const Context& context) : size_(std::min(worker_count(context), kMostThreads)) {}
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  std::size_t size() const { return size_; }

  /// body(i, worker) for i below n, worker below size(): `grain` of them after each other by one thread. Returns when
  /// all is done; rethrows one of the exceptions of bodies.
  template <class Body>
  void run(std::size_t n, std::size_t grain, const Body& body) {
    const auto block = [&](std::size_t b, std::size_t worker) {
      const std::size_t end = std::min(n, (b + 1) * grain);
      for (std::size_t i = b * grain; i < end; ++i) body(i, worker);
    };
    run_blocks((n + grain - 1) / grain, {&block, [](const void* self, std::size_t b, std::size_t worker) {
                                           (*static_cast<const decltype(block)*>(self))(b, worker);
                                         }});
  }

 private:
  /// What the blocks of a phase do; refers to an object of the caller.
  struct Job {
    const void* self = nullptr;
    void (*call)(const void* self, std::size_t block, std::size_t worker) = nullptr;
  };

  /// The blocks of one thread, and how many of them nobody has claimed.
  struct alignas(64) Share {
    std::atomic<std::uint32_t> unclaimed = 0;
    std::uint32_t end = 0;
  };

  void run_blocks(std::size_t blocks, Job job);
  void start();
  void help(std::size_t worker);
  void begin_phase();
  void work_on_all(std::size_t worker);
  bool claim(std::size_t worker, std::uint32_t& block);
  void work(std::uint32_t block, std::size_t worker);

  std::size_t size_;
  std::vector<std::thread> helpers_;
  std::vector<Share> shares_;  ///< empty until the start
  Job job_;                    ///< stays what it is from the claim of one of its blocks until that is finished
  std::mutex failure_lock_;
  std::exception_ptr failure_;
  std::atomic<bool> is_closed_ = false;
  alignas(64) std::atomic<std::uint32_t> unfinished_ = 0;  ///< blocks
  alignas(64) std::atomic<std::uint32_t> phase_ = 0;       ///< what helpers look at while they wait
};

}  // namespace curvetet
