// Face meshes by definition: circles that hold no node, and what a split of a segment would run into. No acceleration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet::oracle {

/// Triangles whose circle strictly holds a node; none in a Delaunay triangulation of a convex domain.
inline std::size_t count_not_delaunay(const FaceMesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& f = mesh.triangle(TriangleId(t));
    if (!f.alive()) continue;
    const auto q = [&](int i) { return mesh.node(f.node[static_cast<std::size_t>(i)]).q; };
    bool empty = true;
    for (std::size_t n = 0; n < mesh.node_count() && empty; ++n) {
      empty = !mesh.triangle_at(NodeId(n)).valid() || incircle(q(0), q(1), q(2), mesh.node(NodeId(n)).q) <= 0;
    }
    count += !empty;
  }
  return count;
}

/// Free edges whose circle strictly holds the node across; none in a constrained Delaunay triangulation.
inline std::size_t count_not_locally_delaunay(const FaceMesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& f = mesh.triangle(TriangleId(t));
    for (std::size_t i = 0; f.alive() && i < 3; ++i) {
      if (f.use[i] != -1) continue;
      for (const NodeId d : mesh.triangle(f.neighbour[i]).node) {
        if (d == f.node[0] || d == f.node[1] || d == f.node[2]) continue;
        const auto q = [&](std::size_t k) { return mesh.node(f.node[k]).q; };
        count += incircle(q(0), q(1), q(2), mesh.node(d).q) > 0;
      }
    }
  }
  return count;
}

inline bool on_segment(Vec2 a, Vec2 b, Vec2 p) {
  return orient2d(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

/// Whether two closed segments have a common point.
inline bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  if (on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b)) return true;
  return orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0;
}

/// Whether the constrained edge ab may become a-q-b: no other node in the closed triangle abq, and the new segments
/// meet no constrained edge but in their ends a and b.
inline bool split_is_clear(const FaceMesh& mesh, FaceEdge edge, Vec2 q) {
  const FaceTriangle& holder = mesh.triangle(edge.triangle);
  const NodeId na = holder.node[static_cast<std::size_t>((edge.local + 1) % 3)];
  const NodeId nb = holder.node[static_cast<std::size_t>((edge.local + 2) % 3)];
  const Vec2 a = mesh.node(na).q, b = mesh.node(nb).q;
  if (q == a || q == b || std::max(std::abs(q.x), std::abs(q.y)) > 1) return false;
  const int turn = orient2d(a, b, q);
  if (turn == 0 && !on_segment(a, b, q)) return false;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const Vec2 p = mesh.node(NodeId(n)).q;
    if (NodeId(n) == na || NodeId(n) == nb || !mesh.triangle_at(NodeId(n)).valid()) continue;
    const bool inside =
        turn != 0 && turn * orient2d(a, b, p) >= 0 && turn * orient2d(b, q, p) >= 0 && turn * orient2d(q, a, p) >= 0;
    if (inside || p == q) return false;
  }
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& f = mesh.triangle(TriangleId(t));
    for (std::size_t i = 0; f.alive() && i < 3; ++i) {
      const NodeId nu = f.node[(i + 1) % 3], nv = f.node[(i + 2) % 3];
      if (f.use[i] == -1 || (nu == na && nv == nb) || (nu == nb && nv == na)) continue;
      const Vec2 u = mesh.node(nu).q, v = mesh.node(nv).q;
      if (on_segment(u, v, q)) return false;
      // A segment that shares a (or b) may meet the new one there only.
      const auto runs_into = [&](NodeId end, Vec2 from) {
        if (nu != end && nv != end) return segments_meet(u, v, from, q);
        const Vec2 far = nu == end ? v : u;
        return on_segment(from, q, far) || on_segment(from, far, q);
      };
      if (runs_into(na, a) || runs_into(nb, b)) return false;
    }
  }
  return true;
}

}  // namespace curvetet::oracle
