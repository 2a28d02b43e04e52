// t_3d of the whole body as one list, and the exact test that no two of its triangles cross.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

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

/// Pairs (i < j) of triangles that cross, sorted; no more than `limit`. Bounding volume hierarchy, then the exact test;
/// O(n log n + pairs).
std::vector<std::pair<std::uint32_t, std::uint32_t>> crossing_pairs(
    const VertexStore& vertices, const std::vector<SurfaceTriangle>& triangles,
    std::size_t limit = std::numeric_limits<std::size_t>::max());

}  // namespace curvetet
