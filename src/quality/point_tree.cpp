// Halves at the median along the longest side of the points' box, so that the shape of the tree follows from the number
// of items alone and a node is no more than a plane. A BoxTree over the points was rejected: it compares six numbers
// where one decides, and searching it took a sixth of a whole run on a mesh of a million tets.
#include "quality/point_tree.h"

#include <algorithm>

namespace curvetet {

PointTree::PointTree(std::vector<Item> items) : items_(std::move(items)) { build({0, 0, items_.size()}); }

void PointTree::build(const Part& part) {
  if (part.end - part.begin <= kLeaf) return;
  Point low = items_[part.begin].point, extent{};
  Point high = low;
  for (std::size_t i = part.begin; i < part.end; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], items_[i].point[k]);
      high[k] = std::max(high[k], items_[i].point[k]);
      extent[k] = high[k] - low[k];
    }
  }
  const auto axis = static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(part.begin), at(part.middle()), at(part.end), [&](const Item& a, const Item& b) {
    return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis] : a.id < b.id;
  });
  if (planes_.size() <= part.node) planes_.resize(part.node + 1);
  planes_[part.node] = {items_[part.middle()].point[axis], axis};
  build({2 * part.node + 1, part.begin, part.middle()});
  build({2 * part.node + 2, part.middle(), part.end});
}

}  // namespace curvetet
