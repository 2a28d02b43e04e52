// Lists made on many threads, in an order that does not depend on them.
#pragma once

#include <algorithm>
#include <vector>

#include "base/context.h"

namespace curvetet {

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
