// Splitting a constrained edge ab at a node q on its arc. The domain gains or loses the triangle abq:
//   on the chord: the edge is cut, as with any other edge;
//   outside: abq becomes a triangle, if no boundary edge and so no part of the domain meets it;
//   inside: q is inserted, aq and qb are recovered, and abq, which is empty, is now one triangle; on the boundary it is
//   removed, and between two sides of the domain it goes over to the other side.
// All tests are exact and made before anything changes.
#include <algorithm>
#include <cmath>

#include "planar/corners.h"
#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

/// A triangle that turns left.
struct Corner {
  Vec2 a, b, c;
  bool contains(Vec2 p) const { return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0; }

  /// The segment uv meets the open triangle. Two convex sets in the plane are separated by a line along one of their
  /// sides.
  bool interior_meets(Vec2 u, Vec2 v) const {
    if (beyond(a, b, u, v) || beyond(b, c, u, v) || beyond(c, a, u, v)) return false;
    const int x = orient2d(u, v, a), y = orient2d(u, v, b), z = orient2d(u, v, c);
    return !(x >= 0 && y >= 0 && z >= 0) && !(x <= 0 && y <= 0 && z <= 0);
  }

 private:
  static bool beyond(Vec2 p, Vec2 r, Vec2 u, Vec2 v) { return orient2d(p, r, u) <= 0 && orient2d(p, r, v) <= 0; }
};

bool in_range(Vec2 q) { return std::fabs(q.x) <= 1 && std::fabs(q.y) <= 1; }

}  // namespace

FaceMesh::SplitPlan FaceMesh::plan_split(FaceEdge edge, Vec2 q) const {
  const auto refuse = [&](PlanarRefusal why) { return SplitPlan{why, SplitPlan::Side::on_chord, edge, {}}; };
  if (!has_edge(edge) || !is_constrained(edge) || !in_range(q)) return refuse(PlanarRefusal::outside);
  const auto [a, b] = ends(edge);
  if (point(a) == q || point(b) == q) return refuse(PlanarRefusal::duplicate);
  const int side = orient2d(point(a), point(b), q);
  if (side > 0) return plan_inside(edge, q);
  if (side < 0) return on_boundary(edge) ? plan_outside(edge, q) : plan_inside(mirror(edge), q);
  const Vec2 p = point(a), r = point(b);
  if (dot(q - p, r - p) <= 0 || dot(q - r, p - r) <= 0) return refuse(PlanarRefusal::folded);
  return refuse(PlanarRefusal::none);
}

// Visits the triangles that meet the open triangle abq, from the chord on, and refuses at the first node in the closed
// one or constraint across it.
FaceMesh::SplitPlan FaceMesh::plan_inside(FaceEdge edge, Vec2 q) const {
  const auto [a, b] = ends(edge);
  const Corner region{point(a), point(b), q};
  SplitPlan plan{PlanarRefusal::invariant, SplitPlan::Side::inside, edge, {}};
  std::vector<TriangleId> visited{edge.triangle};
  for (std::size_t k = 0; k < visited.size(); ++k) {
    const TriangleId t = visited[k];
    const FaceTriangle& f = triangles_[t];
    for (const NodeId n : f.node) {
      if (n != a && n != b && region.contains(point(n))) {
        if (point(n) == q) plan.refusal = PlanarRefusal::duplicate;
        return plan;
      }
    }
    if (contains(t, q) && (!plan.holder.valid() || t < plan.holder)) plan.holder = t;
    for (int i = 0; i < 3; ++i) {
      const auto [u, v] = ends({t, i});
      const bool chord = (u == a && v == b) || (u == b && v == a);
      if (chord) continue;
      if (f.use[i] != -1 && orient2d(point(u), point(v), q) == 0 && contains(t, q)) return plan;  // q on a constraint
      if (!region.interior_meets(point(u), point(v))) continue;
      if (f.use[i] != -1) return plan;
      const TriangleId n = f.neighbour[i];
      if (std::find(visited.begin(), visited.end(), n) == visited.end()) visited.push_back(n);
    }
  }
  CURVETET_CHECK(plan.holder.valid());
  plan.refusal = PlanarRefusal::none;
  return plan;
}

// What lies outside of the chord and meets the closed triangle has a boundary edge that does. One from a (or b) may
// leave the triangle there: it must not point into the closed angle of the triangle at a.
FaceMesh::SplitPlan FaceMesh::plan_outside(FaceEdge edge, Vec2 q) const {
  const std::array<NodeId, 2> chord = ends(edge);
  const NodeId na = chord[0], nb = chord[1];
  const Vec2 a = point(na), b = point(nb);
  const Corner region{b, a, q};
  SplitPlan plan{PlanarRefusal::none, SplitPlan::Side::outside, edge, {}};
  const Vec2 low{std::min({a.x, b.x, q.x}), std::min({a.y, b.y, q.y})};
  const Vec2 high{std::max({a.x, b.x, q.x}), std::max({a.y, b.y, q.y})};
  const auto in_angle = [](Vec2 apex, Vec2 right, Vec2 left, Vec2 p) {
    return orient2d(apex, right, p) >= 0 && orient2d(apex, left, p) <= 0;
  };
  boundary_.near(low, high, [&](SegmentGrid::Entry e) {
    if (plan.refusal == PlanarRefusal::duplicate) return;
    const NodeId nu(e.a), nv(e.b);
    if ((nu == na && nv == nb) || (nu == nb && nv == na)) return;
    const Vec2 u = point(nu), v = point(nv);
    bool bad = false;
    if (nu == na || nv == na) {
      bad = in_angle(a, q, b, nu == na ? v : u);
    } else if (nu == nb || nv == nb) {
      bad = in_angle(b, a, q, nu == nb ? v : u);
    } else {
      bad = region.contains(u) || region.contains(v) || region.interior_meets(u, v) ||
            (orient2d(u, v, q) == 0 && dot(u - q, v - q) <= 0);
    }
    if (u == q || v == q) {
      plan.refusal = PlanarRefusal::duplicate;
    } else if (bad) {
      plan.refusal = PlanarRefusal::invariant;
    }
  });
  return plan;
}

PlanarRefusal FaceMesh::judge_split(FaceEdge edge, Vec2 q) const { return plan_split(edge, q).refusal; }

NodeId FaceMesh::split(FaceEdge edge, VertexId vertex, Vec2 q, const FlipWanted& wanted,
                       std::vector<TriangleId>& changed) {
  const SplitPlan plan = plan_split(edge, q);
  changed.clear();
  if (plan.refusal != PlanarRefusal::none) return NodeId();
  const NodeId n = add_node(vertex, q);
  const auto [a, b] = ends(plan.edge);
  const bool boundary = on_boundary(plan.edge);
  if (boundary) boundary_.remove({a.value(), b.value()}, point(a), point(b));
  std::vector<TriangleId> made;
  switch (plan.side) {
    case SplitPlan::Side::on_chord:
      place_on_edge(n, plan.edge, made);
      break;
    case SplitPlan::Side::inside:
      split_inside(plan.edge, n, plan.holder, made);
      break;
    case SplitPlan::Side::outside:
      split_outside(plan.edge, n, made);
      break;
  }
  if (boundary) {
    boundary_.add({a.value(), n.value()}, point(a), point(n));
    boundary_.add({n.value(), b.value()}, point(n), point(b));
    if (boundary_.size() > boundary_.capacity()) index_boundary();
  }
  std::erase_if(made, [this](TriangleId t) { return !triangles_[t].alive(); });
  if (wanted) restore_around(made, wanted);
  changed = std::move(made);
  return n;
}

void FaceMesh::split_inside(FaceEdge edge, NodeId n, TriangleId holder, std::vector<TriangleId>& made) {
  const auto [a, b] = ends(edge);
  place(n, holder, made);
  recover_edge(a, n, made);
  recover_edge(n, b, made);
  const std::optional<FaceEdge> chord = find_edge(a, b);
  CURVETET_CHECK(chord && ends(*chord)[0] == a && triangles_[chord->triangle].node[chord->local] == n);
  const TriangleId t = chord->triangle;
  const FaceEdge beyond_bn = across({t, next(chord->local)}), beyond_na = across({t, previous(chord->local)});
  const std::int32_t use = triangles_[t].use[chord->local];
  triangles_[beyond_bn.triangle].use[beyond_bn.local] = use;
  triangles_[beyond_na.triangle].use[beyond_na.local] = use;
  ++constrained_;
  if (on_boundary(*chord)) {
    link(beyond_bn, FaceEdge{});
    link(beyond_na, FaceEdge{});
    node_triangle_[a] = beyond_na.triangle;
    node_triangle_[b] = beyond_bn.triangle;
    node_triangle_[n] = beyond_na.triangle;
    remove_triangle(t);
    return;
  }
  const FaceEdge other = mirror(*chord);
  FaceTriangle& f = triangles_[t];
  const std::int32_t other_use = triangles_[other.triangle].use[other.local];
  triangles_[other.triangle].use[other.local] = -1;
  f.use[chord->local] = -1;
  f.use[next(chord->local)] = other_use;
  f.use[previous(chord->local)] = other_use;
  ++constrained_;
  made.push_back(other.triangle);
}

void FaceMesh::split_outside(FaceEdge edge, NodeId n, std::vector<TriangleId>& made) {
  const auto [a, b] = ends(edge);
  const std::int32_t use = triangles_[edge.triangle].use[edge.local];
  const TriangleId t = add_triangle(b, a, n);
  triangles_[t].use = {use, use, -1};  // opposite b: (a, n); opposite a: (n, b)
  link({t, 2}, edge);
  triangles_[edge.triangle].use[edge.local] = -1;
  ++constrained_;
  made.insert(made.end(), {t, edge.triangle});
}

}  // namespace curvetet
