// Sorting on all threads, where the order does not depend on them.
#pragma once

#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

#include "base/context.h"

namespace curvetet {

/// Sorts by `less`. Elements of which neither is less must be equal in all that matters: nothing is said of their
/// order.
template <class T, class Less>
void parallel_sort(const Context& context, std::vector<T>& items, const Less& less) {
  constexpr std::size_t kWorthThreads = 4096;
  const std::size_t workers = worker_count(context);
  if (workers == 1 || items.size() < kWorthThreads) {
    std::sort(items.begin(), items.end(), less);
    return;
  }
  tbb::task_arena arena(static_cast<int>(workers));
  arena.execute([&] { tbb::parallel_sort(items.begin(), items.end(), less); });
}

}  // namespace curvetet
