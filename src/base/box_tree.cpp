// Split at the median of the box centres along the longest side of their extent: balanced, so the depth is bounded
// whatever the input, and good enough that the exact tests dominate. A surface-area heuristic was not worth its build
// time here.
#include "base/box_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace curvetet {
namespace {

constexpr std::uint32_t kLeaf = 4;
/// Depth of a balanced tree over 2^32 items, with one pending sibling per level.
constexpr std::size_t kStack = 64;

bool meet(const Box3& a, const Box3& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

double box_distance2(const Box3& box, Vec3 p) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double outside = std::max({box.low[i] - p[i], p[i] - box.high[i], 0.0});
    sum += outside * outside;
  }
  return sum;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box3>& boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.reserve(boxes.size());
  if (!boxes.empty()) build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t item : items_) boxes_.push_back(boxes[item]);
}

std::uint32_t BoxTree::build(const std::vector<Box3>& boxes, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box3 box, centres;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box3& b = boxes[items_[i]];
    box.extend(b.low);
    box.extend(b.high);
    centres.extend(b.centre());
  }
  nodes_[index] = {box, begin, end, 0};
  if (end - begin <= kLeaf) return index;
  const Vec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double x = boxes[i].low[axis] + boxes[i].high[axis];
                     const double y = boxes[j].low[axis] + boxes[j].high[axis];
                     return x != y ? x < y : i < j;
                   });
  build(boxes, begin, middle);
  nodes_[index].right = build(boxes, middle, end);
  return index;
}

void BoxTree::overlaps(const Box3& query, std::vector<std::uint32_t>& items) const {
  if (nodes_.empty()) return;
  std::array<std::uint32_t, kStack> stack{};
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t n = stack[--top];
    const Node& node = nodes_[n];
    if (!meet(node.box, query)) continue;
    if (node.right != 0) {
      stack[top++] = node.right;
      stack[top++] = n + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (meet(boxes_[i], query)) items.push_back(items_[i]);
    }
  }
}

std::uint32_t BoxTree::nearest(Vec3 point, const std::function<double(std::uint32_t)>& distance2) const {
  std::uint32_t best = std::numeric_limits<std::uint32_t>::max();
  if (nodes_.empty()) return best;
  double best2 = std::numeric_limits<double>::infinity();
  std::array<std::uint32_t, kStack> stack{};
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::uint32_t n = stack[--top];
    const Node& node = nodes_[n];
    if (!(box_distance2(node.box, point) < best2)) continue;
    if (node.right != 0) {
      std::uint32_t near = n + 1, far = node.right;
      if (box_distance2(nodes_[far].box, point) < box_distance2(nodes_[near].box, point)) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (!(box_distance2(boxes_[i], point) < best2)) continue;
      const double d2 = distance2(items_[i]);
      if (d2 < best2) {
        best2 = d2;
        best = items_[i];
      }
    }
  }
  return best;
}

}  // namespace curvetet
