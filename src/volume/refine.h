// Interior refinement: vertices inside the solids until tets have the size asked for.
#pragma once

#include <cstddef>

#include "base/context.h"
#include "base/error.h"
#include "mesh/vertex_store.h"
#include "sizing/size_field.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

struct RefineOptions {
  double radius_edge = 2.0;             ///< wanted bound of circumradius over shortest edge; at least 1
  std::size_t max_points = 50'000'000;  ///< vertices to insert at most
};

struct RefineResult {
  std::size_t inserted = 0;
  std::size_t unmet = 0;          ///< tets that are larger or worse than wanted, with no legal place for a vertex
  bool budget_exhausted = false;  ///< stopped by max_points
};

/// Inserts vertices into the tets of the solids (region > 0) by Delaunay refinement, until every tet meets the size
/// field and the radius-edge bound or has no legal place for a vertex.
///
/// Before: every facet between two regions is locked; the store is that of the mesh.
/// After: locked facets and kept segments are unchanged. Every new vertex is Owner::of(its SolidId), Origin::interior,
/// on the grid, at least 0.6 times the size there (or the shortest edge of the bad tet it mends) from every vertex it
/// sees, and outside the equatorial spheres of the locked facets it sees. The same for any number of threads. Tets
/// are renumbered. The radius-edge bound cannot be had next to coarse locked facets: such tets are counted as unmet.
/// Ends: vertices keep a distance from each other, so finitely many fit; each tet is looked at once. An error only if
/// the context asks to stop; the mesh is then valid.
Result<RefineResult> refine_interior(Tetrahedralization& mesh, VertexStore& vertices, const SizeField& field,
                                     const RefineOptions& options, Context& context);

}  // namespace curvetet
