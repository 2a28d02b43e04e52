// Patches by place: which of them have a box near a given box.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace curvetet::sizing {

/// Bounding volume hierarchy over boxes. Immutable once made.
class PatchTree {
 public:
  explicit PatchTree(std::vector<Box3> boxes);
  /// Appends the indices of the boxes within `reach` (per axis) of the box, in an order fixed by the tree.
  void near(const Box3& box, double reach, std::vector<std::uint32_t>& found) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t begin = 0, end = 0, right = 0;
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  std::vector<Box3> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace curvetet::sizing
