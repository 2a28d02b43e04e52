// What a tetrahedralization must satisfy, checked from scratch and told in words. For tests and paranoid runs: slow.
#pragma once

#include <string>
#include <vector>

#include "spatial/tetrahedralization.h"

namespace curvetet {

/// What is broken, at most twenty findings; empty if all is well:
///   links are reciprocal and both sides see the same three vertices in opposite order; every finite tet is exactly
///   positive; the ghosts form a sphere over a convex hull; tet_of is right for every vertex; locks are on both sides
///   of a facet, of finite vertices, and have a face; kept segments are edges.
/// With `delaunay`: no unlocked facet has the opposite vertex in its perturbed sphere, also on the hull.
std::vector<std::string> check_tetrahedralization(const Tetrahedralization& mesh, bool delaunay);

}  // namespace curvetet
