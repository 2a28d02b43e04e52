// Curves that end short of the vertices of their edges. Inside cad only.
#pragma once

#include "cad/body.h"

namespace curvetet {

/// Joins each edge whose curve ends farther than `least` from the edge's vertex to it by a straight edge, where that
/// lies on all faces of the edge within `tolerance` (both in the unit of the shape, `least` above `tolerance`) and does
/// not turn back along the edge. Notes each edge that is joined; returns whether there was one.
bool complete_edges(CadBody& body, double least, double tolerance);

}  // namespace curvetet
