// The exact test that two triangles of one set of vertices meet only where they should.
#pragma once

#include <array>

#include "mesh/vertex_store.h"

namespace curvetet {

/// Do two triangles meet elsewhere than in shared vertices and edges? Exact. Equal triangles do not.
bool triangles_cross(const VertexStore& vertices, const std::array<VertexId, 3>& a, const std::array<VertexId, 3>& b);

}  // namespace curvetet
