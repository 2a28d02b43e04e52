// Crossing triangles are found with a bounding volume hierarchy over those that are asked for, which is small where few
// have changed, and decided exactly. A plane sweep was rejected: CAD triangles differ too much in size.
#include "boundary/surface_triangles.h"

#include <algorithm>

#include "base/box_tree.h"
#include "base/gather.h"

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

std::vector<TrianglePair> crossing_pairs(const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles,
                                         const std::vector<char>& is_fresh, std::size_t limit, const Context& context) {
  std::vector<Box3> boxes(triangles.size()), fresh_boxes;
  std::vector<std::uint32_t> fresh, order;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    for (VertexId v : triangles[i].vertices) boxes[i].extend(vertices.position(v));
    if (is_fresh[i] == 0) {
      order.push_back(i);
    } else {
      fresh.push_back(i);
      fresh_boxes.push_back(boxes[i]);
    }
  }
  const BoxTree tree(fresh_boxes);
  for (const std::uint32_t k : tree.items()) order.push_back(fresh[k]);
  constexpr std::size_t kBlock = 1024, kMostInBlock = 64 * kBlock;
  auto found = gather<TrianglePair>(context, order.size(), kBlock, [&](std::size_t at, std::vector<TrianglePair>& out) {
    if (out.size() >= kMostInBlock) return;
    const std::uint32_t i = order[at];
    std::vector<std::uint32_t> near;
    tree.overlaps(boxes[i], near);
    for (const std::uint32_t k : near) {
      const std::uint32_t j = fresh[k];
      if (is_fresh[i] != 0 && j <= i) continue;
      if (triangles_cross(vertices, triangles[i].vertices, triangles[j].vertices))
        out.emplace_back(std::min(i, j), std::max(i, j));
    }
  });
  std::sort(found.begin(), found.end());
  if (found.size() > limit) found.resize(limit);
  return found;
}

std::vector<TrianglePair> crossing_pairs(const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles,
                                         const Context& context) {
  const std::vector<char> all(triangles.size(), 1);
  return crossing_pairs(vertices, triangles, all, std::numeric_limits<std::size_t>::max(), context);
}

}  // namespace curvetet
