// t_3d of the whole body as one list, and the exact test that no two of its triangles cross.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/context.h"
#include "conjoint/surface_meshes.h"
#include "mesh/vertex_store.h"
#include "spatial/triangles_cross.h"

namespace curvetet {

/// A triangle of some t_3d with three different vertices.
struct SurfaceTriangle {
  FaceId face;
  TriangleId triangle;
  std::array<VertexId, 3> vertices;  ///< turn left in the chart
};

/// All triangles of t_3d, in the order of faces and triangles; those that collapse in space (at poles) are left out.
std::vector<SurfaceTriangle> surface_triangles(const BoundaryMesh& boundary);
std::vector<SurfaceTriangle> surface_triangles(const FaceMesh& mesh, FaceId face);

/// Sorted vertex values: the identity of a facet.
using FacetKey = std::array<std::uint32_t, 3>;
FacetKey facet_key(VertexId a, VertexId b, VertexId c);

using TrianglePair = std::pair<std::uint32_t, std::uint32_t>;
inline constexpr std::size_t kAllPairs = std::numeric_limits<std::size_t>::max();

/// Pairs (i < j) of triangles that cross, sorted. Bounding volume hierarchy, then the exact test; O(n log n + pairs).
std::vector<TrianglePair> crossing_pairs(const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles,
                                         const Context& context);
/// Those of which one at least is fresh; `limit` of them where there are as many. Time in proportion to the number of
/// triangles, and n log n for the fresh ones.
std::vector<TrianglePair> crossing_pairs(const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles,
                                         const std::vector<char>& is_fresh, std::size_t limit, const Context& context);

}  // namespace curvetet
