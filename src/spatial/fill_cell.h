// Tetrahedra for a small polyhedron whose surface triangles are given.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/tet_complex.h"
#include "mesh/vertex_store.h"

namespace curvetet {

/// A triangle of the surface of a cell: orient3d(side, x) is positive for x within the cell next to it.
using CellSide = std::array<VertexId, 3>;

struct CellFill {
  std::vector<TetComplex::Vertices> tets;  ///< empty: none were found
  std::size_t points = 0;                  ///< new vertices among them
  std::vector<CellSide> stuck;  ///< if none were found: all sides, first those that no tet fits on most often
};

/// Positive tets (exactly) that fill the cell and have its sides as facets. Before: every edge of the surface is in two
/// sides, and no two sides cross. `add_vertex` makes a vertex near a point, on the grid; if it is empty, or if the
/// vertices of the cell are enough, none is added. O(sides) tests for each of at most a few thousand steps of a search.
CellFill fill_cell(const VertexStore& vertices, const std::vector<CellSide>& sides,
                   const std::function<VertexId(Vec3)>& add_vertex);

}  // namespace curvetet
