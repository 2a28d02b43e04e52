// Crossing triangles are found with a bounding volume hierarchy over those that are asked for, which is small where few
// have changed, and decided exactly. A plane sweep was rejected: CAD triangles differ too much in size.
#include "boundary/surface_triangles.h"

#include <algorithm>

#include "base/box_tree.h"
#include "base/gather.h"

namespace curvetet {

namespace {

/// Triangles that one thread looks at, and that are looked at before the pairs are counted.
constexpr std::size_t kBlock = 1024, kStretch = 32 * kBlock;

}  // namespace

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
  // In stretches, so that little is found beyond the limit, and the same for any number of threads.
  std::vector<TrianglePair> found;
  for (std::size_t begin = 0; begin < order.size() && found.size() < limit; begin += kStretch) {
    const std::size_t count = std::min(kStretch, order.size() - begin);
    const auto more = gather<TrianglePair>(context, count, kBlock, [&](std::size_t at, std::vector<TrianglePair>& out) {
      if (out.size() >= limit) return;
      const std::uint32_t i = order[begin + at];
      std::vector<std::uint32_t> near;
      tree.overlaps(boxes[i], near);
      for (const std::uint32_t k : near) {
        const std::uint32_t j = fresh[k];
        if (is_fresh[i] != 0 && j <= i) continue;
        if (triangles_cross(vertices, triangles[i].vertices, triangles[j].vertices))
          out.emplace_back(std::min(i, j), std::max(i, j));
      }
    });
    found.insert(found.end(), more.begin(), more.end());
  }
  std::sort(found.begin(), found.end());
  if (found.size() > limit) found.resize(limit);
  return found;
}

std::vector<TrianglePair> crossing_pairs(const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles,
                                         const Context& context) {
  const std::vector<char> all(triangles.size(), 1);
  return crossing_pairs(vertices, triangles, all, kAllPairs, context);
}

}  // namespace curvetet
