// Crossing triangles are found with a bounding volume hierarchy (median split, boxes in one flat array) and decided
// exactly. A plane sweep was rejected: CAD triangles differ too much in size.
#include "boundary/surface_triangles.h"

#include <algorithm>
#include <numeric>

namespace curvetet {

std::vector<SurfaceTriangle> surface_triangles(const FaceMesh& mesh, FaceId face) {
  std::vector<SurfaceTriangle> list;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const TriangleId id(t);
    if (!mesh.triangle(id).alive()) continue;
    const std::array<VertexId, 3> v = mesh.vertices(id);
    if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) list.push_back({face, id, v});
  }
  return list;
}

std::vector<SurfaceTriangle> surface_triangles(const BoundaryMesh& boundary) {
  std::vector<SurfaceTriangle> all;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    const auto list = surface_triangles(boundary.faces[FaceId(f)], FaceId(f));
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

FacetKey facet_key(VertexId a, VertexId b, VertexId c) {
  FacetKey key{a.value(), b.value(), c.value()};
  std::sort(key.begin(), key.end());
  return key;
}

namespace {

class TriangleTree {
 public:
  TriangleTree(const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles)
      : vertices_(vertices), triangles_(triangles), order_(triangles.size()) {
    boxes_.resize(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (VertexId v : triangles[i].vertices) boxes_[i].extend(vertices.position(v));
    std::iota(order_.begin(), order_.end(), 0U);
    if (!triangles.empty()) build(0, order_.size());
  }

  std::vector<std::pair<std::uint32_t, std::uint32_t>> crossings(std::size_t limit) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (std::uint32_t i = 0; i < triangles_.size() && found.size() < limit; ++i) query(i, found);
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  struct Node {
    Box3 box;
    std::uint32_t begin = 0, end = 0, right = 0;  // right child; the left one follows its parent; 0: leaf
  };

  static bool meet(const Box3& a, const Box3& b) {
    for (int k = 0; k < 3; ++k)
      if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
    return true;
  }

  std::uint32_t build(std::size_t begin, std::size_t end) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    node.begin = static_cast<std::uint32_t>(begin);
    node.end = static_cast<std::uint32_t>(end);
    for (std::size_t i = begin; i < end; ++i) {
      node.box.extend(boxes_[order_[i]].low);
      node.box.extend(boxes_[order_[i]].high);
    }
    nodes_.push_back(node);
    if (end - begin <= 4) return at;
    const Vec3 extent = node.box.high - node.box.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto key = [&](std::uint32_t i) { return boxes_[i].low[axis] + boxes_[i].high[axis]; };
    const std::size_t middle = (begin + end) / 2;
    const auto first = order_.begin();
    std::nth_element(first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(middle),
                     first + static_cast<std::ptrdiff_t>(end),
                     [&](std::uint32_t i, std::uint32_t j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
    build(begin, middle);
    nodes_[at].right = build(middle, end);
    return at;
  }

  void query(std::uint32_t i, std::vector<std::pair<std::uint32_t, std::uint32_t>>& found) const {
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
      const std::uint32_t at = stack.back();
      const Node& node = nodes_[at];
      stack.pop_back();
      if (!meet(node.box, boxes_[i])) continue;
      if (node.right != 0) {
        stack.push_back(at + 1);
        stack.push_back(node.right);
        continue;
      }
      for (std::uint32_t k = node.begin; k < node.end; ++k) {
        const std::uint32_t j = order_[k];
        if (j > i && meet(boxes_[i], boxes_[j]) &&
            triangles_cross(vertices_, triangles_[i].vertices, triangles_[j].vertices))
          found.emplace_back(i, j);
      }
    }
  }

  const VertexStore& vertices_;
  const std::vector<SurfaceTriangle>& triangles_;
  std::vector<Box3> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> crossing_pairs(const VertexStore& vertices,
                                                                    const std::vector<SurfaceTriangle>& triangles,
                                                                    std::size_t limit) {
  return TriangleTree(vertices, triangles).crossings(limit);
}

}  // namespace curvetet
