// Better places for the nodes inside a face, once their number is right.
#pragma once

#include <vector>

#include "base/context.h"
#include "boundary/criteria.h"
#include "planar/face_mesh.h"

namespace curvetet {

/// Moves nodes towards the middle of their neighbours, on the surface, where that lowers the sum of the inverse mean
/// ratios of the triangles around (Munson, "Mesh shape-quality optimization using the inverse mean-ratio metric",
/// 2007), and flips in between as the criterion wants. `corners`, by node, are kept true. Nodes below `first` stay, and
/// so does every node with a constrained edge. After: all triangles turn left in the chart, none has been turned away
/// from the surface. A few sweeps, each linear in the number of nodes.
void smooth_face(FaceMesh& mesh, NodeId first, std::vector<Corner>& corners, const ChartSurface& on,
                 const FaceMesh::FlipWanted& wanted, const Context& context);

}  // namespace curvetet
