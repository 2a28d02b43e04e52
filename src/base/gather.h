// Loops in blocks on many threads, and lists that are made so, in an order that does not depend on the threads.
#pragma once

#include <algorithm>
#include <vector>

#include "base/context.h"

namespace curvetet {

/// body(begin, end) over the blocks of [0, n).
template <class Body>
void in_blocks(const Context& context, std::size_t n, std::size_t block, const Body& body) {
  parallel_for(context, (n + block - 1) / block, [&](std::size_t k) { body(k * block, std::min(n, (k + 1) * block)); });
}

/// What body(i, out) appends to `out` for i in [0, n), in the order of i. Each thread takes blocks of `block`.
template <class T, class Body>
std::vector<T> gather(const Context& context, std::size_t n, std::size_t block, const Body& body) {
  std::vector<std::vector<T>> parts((n + block - 1) / block);
  parallel_for(context, parts.size(), [&](std::size_t part) {
    const std::size_t end = std::min(n, (part + 1) * block);
    for (std::size_t i = part * block; i < end; ++i) body(i, parts[part]);
  });
  std::vector<T> all;
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace curvetet
