// Union-find.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace curvetet {

/// The numbers below n in sets, each on its own at first. The least member of a set is its root. Paths are halved, so
/// that both operations are all but constant in time.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  bool is_root(std::uint32_t i) const { return parent_[i] == i; }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace curvetet
