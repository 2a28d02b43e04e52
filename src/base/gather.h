// Loops in blocks on many threads, and lists that are made so, in an order that does not depend on the threads.
#pragma once

#include <algorithm>
#include <vector>

#include "base/context.h"

namespace curvetet {

/// A block where an item takes well below a microsecond: far more than handing out a block costs.
inline constexpr std::size_t kLargeBlock = 8192;

/// body(begin, end) over the blocks of [0, n).
template <class Body>
void in_blocks(const Context& context, std::size_t n, std::size_t block, const Body& body) {
  parallel_for(context, (n + block - 1) / block, [&](std::size_t k) { body(k * block, std::min(n, (k + 1) * block)); });
}

/// What body(i, out) appends to `out` for i in [0, n), in the order of i. Each thread takes blocks of `block`.
template <class T, class Body>
std::vector<T> gather(const Context& context, std::size_t n, std::size_t block, const Body& body) {
  std::vector<std::vector<T>> parts((n + block - 1) / block);
  in_blocks(context, n, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i, parts[begin / block]);
  });
  std::vector<T> all;
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace curvetet
