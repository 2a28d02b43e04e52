// Crossings of chains in a chart that are no larger than the tolerances of the curves.
#pragma once

#include <functional>
#include <vector>

#include "geometry/surface.h"
#include "planar/face_mesh.h"

namespace curvetet {

/// Moves chart points of inner nodes of chains across the segments they should not have crossed, as far as the move is
/// within the tolerance of the two curves in space. (The position of a vertex in space is that of its curve; its chart
/// point may be off by the tolerance.) `tolerance` gives that of a use, in working units. Returns whether any point was
/// moved; each fault moves one point at most.
bool untangle(const std::vector<LoopFault>& faults, const Surface& surface, const Chart& chart,
              const std::function<double(std::int32_t use)>& tolerance, FaceInput& input);

}  // namespace curvetet
