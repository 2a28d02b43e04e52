#include "base/context.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace curvetet {

Error Context::stop_error(std::string_view stage) const {
  if (cancelled()) return {ErrorCode::cancelled, fmt::format("cancelled during {}", stage)};
  return {ErrorCode::time_limit,
          fmt::format("time limit reached during {}", stage),
          {},
          {},
          "raise --time-limit or ask for a larger --size"};
}

void Context::progress(std::string_view stage, double begin, double end) {
  stage_ = stage;
  stage_begin_ = begin;
  stage_end_ = end;
  advance(0);
}

void Context::advance(double share) {
  const double fraction = stage_begin_ + std::clamp(share, 0.0, 1.0) * (stage_end_ - stage_begin_);
  reported_ = std::max(reported_, std::clamp(fraction, 0.0, 1.0));
  if (on_progress) on_progress(stage_, reported_);
}

std::size_t worker_count(const Context& context) {
  // The thread library warns on the terminal if it is asked for more threads than the machine has.
  const int most = tbb::info::default_concurrency();
  return static_cast<std::size_t>(context.threads > 0 ? std::min(context.threads, most) : most);
}

void parallel_for(const Context& context, std::size_t n, const std::function<void(std::size_t)>& body) {
  parallel_for(context, n, [&](std::size_t i, std::size_t) { body(i); });
}

void parallel_for(const Context& context, std::size_t n,
                  const std::function<void(std::size_t i, std::size_t worker)>& body) {
  const std::size_t workers = worker_count(context);
  if (workers == 1 || n < 2) {
    for (std::size_t i = 0; i < n; ++i) body(i, 0);
    return;
  }
  tbb::task_arena arena(static_cast<int>(workers));
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, n, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const auto worker = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
          for (std::size_t i = range.begin(); i != range.end(); ++i) body(i, worker);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace curvetet
