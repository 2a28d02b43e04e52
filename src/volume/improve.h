// Improvement of the tets inside the solids: reconnection, smoothing, and a few vertices where nothing else helps.
#pragma once

#include <cstddef>
#include <functional>

#include "base/context.h"
#include "base/error.h"
#include "mesh/vertex_store.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

struct ImproveOptions {
  double goal = 25;  ///< degrees: tets with all dihedral angles between this and 180 minus this are left alone
  double insertion_goal = 12;  ///< degrees: tets worse than this, after all else, may get a vertex
  int rounds = 4;              ///< of (reconnect, smooth) to convergence, then vertices
  bool insert_vertices = true;
  /// Whether a facet with these vertices may represent the CAD face (normal, deviation); without it no lock is
  /// exchanged.
  std::function<bool(VertexId, VertexId, VertexId, FaceId)> facet_allowed;
};

struct ImproveResult {
  std::size_t edge_removals = 0, face_removals = 0, moves = 0, inserted = 0;
  std::size_t relocks = 0;  ///< pairs of locked facets exchanged for the other diagonal
  double worst_before = 0;  ///< degrees, the arc sine of the least sine of a dihedral angle
  double worst_after = 0;
};

/// Improves the tets of the solids (region > 0). The measure of a tet is the least sine of its dihedral angles.
///
/// Before: every facet between two regions is locked; the store is that of the mesh.
/// After: every tet is exactly positive; the worst tet is no worse than before, and so it is for every single change in
/// what it replaced, but for tets over needles (triangles with an angle below five degrees): these may lose down to one
/// degree for the others' sake. Boundary vertices have not moved, kept segments are there. Locked facets are unchanged,
/// but for the exchange of two locked facets of one CAD face for the other two facets of a flat tet, where
/// `facet_allowed` agrees: that tet then belongs to what was on the other side. The same for any number of threads.
/// Ends: rounds and sweeps are bounded, and each change raises the worst tet of what it replaces. An error only if the
/// context asks to stop; the mesh is then valid.
Result<ImproveResult> improve(Tetrahedralization& mesh, VertexStore& vertices, const ImproveOptions& options,
                              Context& context);

}  // namespace curvetet
