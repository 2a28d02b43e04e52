// What flips do not reach: the tetrahedralization around it is made anew (spatial/refill.h), if
// allowed with points in the volume. None is ever put on a facet, where it would lie off the surface.
#pragma once

#include <cstddef>

#include "conjoint/conjoint.h"

namespace curvetet {

struct FillResult {
  std::size_t recovered = 0;  ///< facets that now exist
  std::size_t points = 0;     ///< in the volume, Origin::steiner, owned by no solid until classification
};

/// Fills the holes of one face: connected sets of missing triangles. Facets of the face that exist are protected, locks
/// of other faces and kept segments stay. Terminates: one attempt for each hole.
FillResult fill_holes(Conjoint& conjoint, FaceId face, bool with_points);

/// Makes a missing segment an edge, together with the surface triangles of all faces around it, with points only if it
/// does not go without; the triangles must not cross others.
FillResult fill_around_segment(Conjoint& conjoint, const Conjoint::Segment& segment);

/// Gives each point in the volume to the solid it was classified into.
void own_points(Conjoint& conjoint);

}  // namespace curvetet
