// A bounding volume hierarchy over a fixed set of items: which meet a box, and which is nearest. Built once, read by
// any thread.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/vec.h"

namespace curvetet {

class BoxTree {
 public:
  /// Items are numbered as the boxes; deterministic.
  explicit BoxTree(const std::vector<Box3>& boxes);

  /// All items in the tree's order: what is near is likely to be near in it.
  const std::vector<std::uint32_t>& items() const { return items_; }

  /// Appends the items whose boxes meet the query (closed boxes), in the tree's order.
  void overlaps(const Box3& query, std::vector<std::uint32_t>& items) const;

  /// The item nearest to a point under `distance2` (squared distance from the point to the item, at least that to its
  /// box); the first in the tree's order among equals; UINT32_MAX when the tree is empty.
  std::uint32_t nearest(Vec3 point, const std::function<double(std::uint32_t)>& distance2) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t begin = 0, end = 0;  ///< items of the leaf, when right == 0
    std::uint32_t right = 0;           ///< the left child is the next node
  };
  std::uint32_t build(const std::vector<Box3>& boxes, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
  std::vector<Box3> boxes_;  ///< in the order of items_
};

}  // namespace curvetet
