// Curves that end short of the vertices of their edges. Inside cad only.
#pragma once

#include "cad/body.h"

namespace curvetet {

/// Joins each edge whose curve ends farther than `least` from the edge's vertex to it by a straight edge, where that
/// lies on all faces of the edge within `tolerance` (both in the unit of the shape, `least` above `tolerance`). Where
/// the vertex's tolerance was raised to span the gap, an exact one takes its place. Notes each edge that is joined;
/// returns whether there was one.
bool complete_edges(CadBody& body, double least, double tolerance);

}  // namespace curvetet
