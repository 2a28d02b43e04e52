// Decided by how many vertices the two share; what is left is a segment against a triangle.
#include "spatial/triangles_cross.h"

#include "predicates/predicates.h"

namespace curvetet {

namespace {

using Triple = std::array<VertexId, 3>;

struct Shared {
  int count = 0;
  std::array<int, 3> in_a{}, in_b{};  // local indices of the shared vertices
};

Shared shared_vertices(const Triple& a, const Triple& b) {
  Shared s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a[static_cast<std::size_t>(i)] == b[static_cast<std::size_t>(j)] && s.count < 3) {
        s.in_a[static_cast<std::size_t>(s.count)] = i;
        s.in_b[static_cast<std::size_t>(s.count)] = j;
        ++s.count;
      }
  return s;
}

// Two triangles over one edge overlap exactly when they are coplanar with both apexes on the same side of the edge.
bool overlap_over_edge(Vec3 p, Vec3 q, Vec3 c, Vec3 d) {
  if (orient3d(p, q, c, d) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int sc = orient2d_dropped(p, q, c, axis), sd = orient2d_dropped(p, q, d, axis);
    if (sc != 0 || sd != 0) return sc == sd;
  }
  return true;
}

}  // namespace

bool triangles_cross(const VertexStore& vertices, const Triple& a, const Triple& b) {
  const Shared s = shared_vertices(a, b);
  if (s.count == 3) return false;
  std::array<Vec3, 3> p{}, q{};
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = vertices.position(a[k]);
    q[k] = vertices.position(b[k]);
  }
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  if (s.count == 2) {
    const std::size_t ca = index(3 - s.in_a[0] - s.in_a[1]), cb = index(3 - s.in_b[0] - s.in_b[1]);
    return overlap_over_edge(p[index(s.in_a[0])], p[index(s.in_a[1])], p[ca], q[cb]);
  }
  if (s.count == 1) {
    // Any meeting away from the shared vertex involves the edge opposite to it in one of the two triangles.
    const std::size_t i = index(s.in_a[0]), j = index(s.in_b[0]);
    return segment_triangle(p[(i + 1) % 3], p[(i + 2) % 3], q[0], q[1], q[2]) != SegmentTriangle::disjoint ||
           segment_triangle(q[(j + 1) % 3], q[(j + 2) % 3], p[0], p[1], p[2]) != SegmentTriangle::disjoint;
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (segment_triangle(p[k], p[(k + 1) % 3], q[0], q[1], q[2]) != SegmentTriangle::disjoint ||
        segment_triangle(q[k], q[(k + 1) % 3], p[0], p[1], p[2]) != SegmentTriangle::disjoint)
      return true;
  return false;
}

}  // namespace curvetet
