// A balanced tree by median splits of box middles; ties go by index, so that the tree depends on the boxes alone.

#include "sizing/patch_tree.h"

#include <algorithm>
#include <numeric>

namespace curvetet::sizing {

namespace {

constexpr std::uint32_t kLeafSize = 4;

bool within(const Box3& a, const Box3& b, double reach) {
  for (int i = 0; i < 3; ++i)
    if (a.low[i] > b.high[i] + reach || b.low[i] > a.high[i] + reach) return false;
  return true;
}

}  // namespace

PatchTree::PatchTree(std::vector<Box3> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t PatchTree::build(std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node{{}, begin, end, 0};
  Box3 middles;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box3& box = boxes_[order_[i]];
    node.box.extend(box.low);
    node.box.extend(box.high);
    middles.extend(box.centre());
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return index;
  const Vec3 extent = middles.high - middles.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = boxes_[a].low[axis] + boxes_[a].high[axis];
                     const double y = boxes_[b].low[axis] + boxes_[b].high[axis];
                     return x != y ? x < y : a < b;
                   });
  build(begin, middle);
  const std::uint32_t right = build(middle, end);
  nodes_[index].right = right;
  return index;
}

void PatchTree::near(const Box3& box, double reach, std::vector<std::uint32_t>& found) const {
  if (nodes_.empty()) return;
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const std::uint32_t index = stack.back();
    stack.pop_back();
    const Node& node = nodes_[index];
    if (!within(node.box, box, reach)) continue;
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (within(boxes_[order_[i]], box, reach)) found.push_back(order_[i]);
      continue;
    }
    stack.push_back(node.right);
    stack.push_back(index + 1);
  }
}

}  // namespace curvetet::sizing
