// Edges of a body that lie in one place though the body does not share them.
#pragma once

#include "geometry/model.h"

namespace curvetet {

/// A body may touch itself along a line: two edges with the same ends and the same points, each between two faces of
/// its own. The CAD keeps the two sides apart there, and the mesh must have points of its own on either. Of each such
/// pair the edge with the sharper wedge is drawn back by a hair into its wedge, fading towards the ends, and is told
/// its twin (ModelEdge::twin). Left alone: pairs whose wedges interlock (there the body crosses itself) or have faces
/// that coincide. Adds a healing note for each. Before: everything but the twins is set.
void part_touching_edges(Model& model);

}  // namespace curvetet
