// A balanced tree over a fixed set of points: which of them lie in a box. Built once, read by any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "curvetet/mesh.h"

namespace curvetet {

class PointTree {
 public:
  struct Item {
    Point point{};
    std::uint32_t id = 0;
  };
  struct Box {
    Point low{}, high{};  ///< closed
    bool contains(const Point& p) const {
      return bool(int(low[0] <= p[0]) & int(p[0] <= high[0]) & int(low[1] <= p[1]) & int(p[1] <= high[1]) &
                  int(low[2] <= p[2]) & int(p[2] <= high[2]));
    }
  };

  /// Deterministic, whatever the order of the items. O(n log n).
  explicit PointTree(std::vector<Item> items);

  /// visit(item) for each item in the box, in the tree's fixed order. At worst, on flat boxes, O(n^(2/3) + found).
  template <class Visit>
  void within(const Box& box, Visit&& visit) const;

 private:
  /// Items begin..end of a node; it is a leaf if they are few. Its halves are the nodes 2k+1 and 2k+2.
  struct Part {
    std::size_t node, begin, end;
    std::size_t middle() const { return begin + (end - begin) / 2; }
  };
  struct Plane {
    double at = 0;
    std::size_t axis = 0;
  };
  static constexpr std::size_t kLeaf = 8;
  /// Parts that wait: one for each level of a tree over 2^32 items.
  static constexpr std::size_t kStack = 32;

  void build(const Part& part);

  std::vector<Item> items_;
  std::vector<Plane> planes_;  ///< by node: items before the middle are not above it, the others not below
};

template <class Visit>
void PointTree::within(const Box& box, Visit&& visit) const {
  std::array<Part, kStack> waiting;
  std::size_t count = 0;
  waiting[count++] = {0, 0, items_.size()};
  while (count > 0) {
    Part part = waiting[--count];
    while (part.end - part.begin > kLeaf) {
      const Plane& plane = planes_[part.node];
      const Part upper{2 * part.node + 2, part.middle(), part.end};
      if (box.low[plane.axis] > plane.at) {
        part = upper;
        continue;
      }
      if (box.high[plane.axis] >= plane.at) waiting[count++] = upper;
      part = {2 * part.node + 1, part.begin, part.middle()};
    }
    for (std::size_t i = part.begin; i < part.end; ++i)
      if (box.contains(items_[i].point)) visit(items_[i]);
  }
}

}  // namespace curvetet
