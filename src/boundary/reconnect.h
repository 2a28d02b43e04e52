// The first rung of the ladder for a stuck hole: reconnect the tetrahedralization around it so that the missing
// triangles of t_ps become facets, without any new point.
#pragma once

#include <vector>

#include "boundary/surface_triangles.h"
#include "conjoint/conjoint.h"

namespace curvetet {

/// The triangles of the face's t_3d that are no facets, or facets that another face has locked.
std::vector<SurfaceTriangle> missing_triangles(const Conjoint& conjoint, FaceId face);

struct ReconnectResult {
  std::size_t recovered = 0;             ///< facets that now exist
  std::vector<SurfaceTriangle> missing;  ///< triangles that still do not
};

/// Recovers the edges, then the facets of all missing triangles of the face by flips. Facets of the face that exist
/// already are protected. The tetrahedralization stays valid whatever happens; nothing is locked afterwards that was
/// not before. Terminates as the flips do (spatial/flips.h); one attempt for each edge and facet.
ReconnectResult reconnect_face(Conjoint& conjoint, FaceId face);

}  // namespace curvetet
