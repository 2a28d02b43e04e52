// The one permitted change of locked facets: the diagonal of a flat tet on one CAD face.
#pragma once

#include <functional>

#include "spatial/tetrahedralization.h"

namespace curvetet {

/// Whether a facet with these vertices (in any order) may represent the CAD face.
using FacetAllowed = std::function<bool(VertexId, VertexId, VertexId, FaceId)>;

/// For a tet of a solid with two locked facets of one CAD face: locks the other two instead, so that the tet goes over
/// to what is behind the face. Done only if the old diagonal is no kept segment and the new one is on no locked facet,
/// both new facets are allowed and look the same way as the old ones, and, if there is a solid behind, the tet can be
/// removed there. Returns whether it was done.
bool exchange_lock(Tetrahedralization& mesh, TetId t, const FacetAllowed& facet_allowed);

}  // namespace curvetet
