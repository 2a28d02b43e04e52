// The disk test around each vertex of a face (the paper's requirements V and VI): edges can all have their two
// triangles where two sheets touch in a vertex, and only going around the vertex tells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "boundary/surface_triangles.h"
#include "planar/face_mesh.h"

namespace curvetet {

/// Triangles around a vertex, joined where exactly two of them share an edge there: rings, and fans with ends.
struct Fans {
  std::size_t closed = 0, open = 0;
  bool operator==(const Fans&) const = default;
};

struct FanFault {
  VertexId vertex;
  Fans found, expected;
};
std::string describe(const FanFault& fault);

/// Vertices, ascending, around which the facets of a face are not what its chart says: an open fan for each corner of
/// the domain at the vertex, corners joined along segments that the face uses twice (seams, slits) and over poles; one
/// closed fan where that leaves no end, and inside. So a vertex that no facet uses is one, and a vertex of another
/// face. O(n log n).
std::vector<FanFault> find_fan_faults(const FaceMesh& t_ps, const std::vector<FacetKey>& facets);

}  // namespace curvetet
