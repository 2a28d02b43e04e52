// Wanted triangles become facets: the tets that they cross are taken out, and the cells into which the triangles cut
// the room that is left are filled anew.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "spatial/tetrahedralization.h"

namespace curvetet {

struct RefillOptions {
  std::size_t most_tets = 300;  ///< that may be taken out
  /// Makes a vertex near a point, on the grid. Empty: no new points.
  std::function<VertexId(Vec3)> add_vertex;
};

struct RefillResult {
  bool done = false;
  std::size_t points = 0;  ///< new vertices, none on a wanted triangle
};

/// Before: the triangles have different vertices, all in the mesh, and do not cross each other; edges of only one of
/// them exist. After (done): every triangle is a facet; locked facets and kept segments are what they were; all tets
/// are positive, exactly. Not done (nothing but the vertex store has changed): a vertex lies on a triangle, a lock or a
/// kept segment is crossed, a vertex would be lost, too many tets are crossed, or a cell is not filled (fill_cell.h)
/// even after a few tets beyond its stuck sides were taken in. O(n log n) in the tets taken out times the triangles,
/// but for the search of the cells.
RefillResult refill(Tetrahedralization& mesh, std::span<const std::array<VertexId, 3>> triangles,
                    const RefillOptions& options);

}  // namespace curvetet
