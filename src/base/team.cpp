// A phase is a number of blocks in each share that nobody has claimed. Whoever lowers it has a block, and with it the
// right to read what the phase does: that changes only when all blocks are finished. So there is nothing to keep apart
// phases by, and a helper that wakes late finds either no block or one of the present phase.
//
// Rejected: a parallel_for of the thread library for each phase. In refinement, whose phases take 50 to 100
// microseconds, two threads were then only 1.2 to 1.3 times as fast as one. A barrier that all threads must reach: one
// that the machine has put aside would hold up all others.
#include "base/team.h"

#include <system_error>
#include <utility>

namespace curvetet {

namespace {

/// Looks for a phase before a helper sleeps; the first ones without giving up the core.
constexpr int kLooks = 20000, kLooksAwake = 2000;

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

void wait_briefly(int looks) {
  if (looks < kLooksAwake) {
    pause_briefly();
  } else {
    std::this_thread::yield();
  }
}

}  // namespace

Team::~Team() {
  is_closed_.store(true, std::memory_order_relaxed);
  begin_phase();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::begin_phase() {
  phase_.fetch_add(1, std::memory_order_release);
  phase_.notify_all();
}

/// A machine that refuses a thread is short of them: those there are will do.
void Team::start() {
  shares_ = std::vector<Share>(size_);
  helpers_.reserve(size_ - 1);
  try {
    while (helpers_.size() + 1 < size_) helpers_.emplace_back(&Team::help, this, helpers_.size() + 1);
  } catch (const std::system_error&) {
  }
}

void Team::run_blocks(std::size_t blocks, Job job) {
  if (size_ == 1 || blocks < 2) {
    for (std::size_t b = 0; b < blocks; ++b) job.call(job.self, b, 0);
    return;
  }
  if (shares_.empty()) start();
  job_ = job;
  unfinished_.store(static_cast<std::uint32_t>(blocks), std::memory_order_relaxed);
  for (std::size_t w = 0; w < size_; ++w) {
    const std::size_t begin = w * blocks / size_, end = (w + 1) * blocks / size_;
    shares_[w].end = static_cast<std::uint32_t>(end);
    shares_[w].unclaimed.store(static_cast<std::uint32_t>(end - begin), std::memory_order_release);
  }
  begin_phase();
  work_on_all(0);
  for (int looks = 0; unfinished_.load(std::memory_order_acquire) != 0; ++looks) wait_briefly(looks);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Team::work_on_all(std::size_t worker) {
  for (std::uint32_t block; claim(worker, block);) work(block, worker);
}

/// Takes a block of the worker's own share, or else of another one, if there is one.
bool Team::claim(std::size_t worker, std::uint32_t& block) {
  for (std::size_t k = 0; k < size_; ++k) {
    Share& share = shares_[(worker + k) % size_];
    std::uint32_t left = share.unclaimed.load(std::memory_order_relaxed);
    while (left != 0) {
      if (share.unclaimed.compare_exchange_weak(left, left - 1, std::memory_order_acquire)) {
        block = share.end - left;
        return true;
      }
    }
  }
  return false;
}

void Team::work(std::uint32_t block, std::size_t worker) {
  try {
    job_.call(job_.self, block, worker);
  } catch (...) {
    const std::lock_guard lock(failure_lock_);
    failure_ = std::current_exception();
  }
  unfinished_.fetch_sub(1, std::memory_order_release);
}

void Team::help(std::size_t worker) {
  std::uint32_t seen = 0;
  while (!is_closed_.load(std::memory_order_relaxed)) {
    work_on_all(worker);
    for (int looks = 0; phase_.load(std::memory_order_acquire) == seen && looks < kLooks; ++looks) wait_briefly(looks);
    phase_.wait(seen, std::memory_order_acquire);
    seen = phase_.load(std::memory_order_acquire);
  }
}

}  // namespace curvetet
