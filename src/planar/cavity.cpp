// A constraint is recovered by removing the triangles it crosses and filling the polygon on each side (Anglada, "An
// improved incremental algorithm for constructing restricted Delaunay triangulations", 1997): the apex over a base edge
// is the node of the chain whose circle through the base holds no other. The apex is visible from the base, since the
// edges that led from the chain's nodes across the constraint lie within the polygon; so every triangle turns left,
// also where the chain runs twice along a dangling edge. Sloan's flips need a queue and an argument for termination;
// this needs neither.
#include <algorithm>

#include "planar/corners.h"
#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

/// A directed edge of the cavity's rim, or of a constraint within it.
struct RimEdge {
  NodeId a, b;
  FaceEdge beyond;  ///< without a triangle: the boundary, or another cavity triangle
  bool outer = false;
  std::int32_t use = -1;
  bool operator<(const RimEdge& r) const { return std::pair(a, b) < std::pair(r.a, r.b); }
};

/// Looks a directed edge up in a sorted list of things with members a and b.
template <class Edge>
const Edge* find_directed(const std::vector<Edge>& sorted, NodeId a, NodeId b) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), std::pair(a, b),
                                   [](const Edge& e, const auto& key) { return std::pair(e.a, e.b) < key; });
  return at != sorted.end() && at->a == a && at->b == b ? &*at : nullptr;
}

struct MadeEdge {
  NodeId a, b;
  FaceEdge edge;
  bool operator<(const MadeEdge& m) const { return std::pair(a, b) < std::pair(m.a, m.b); }
};

}  // namespace

// polygon[0] and polygon.back() are the ends of the base; the interior lies to the left of base and to the right of the
// chain.
void FaceMesh::fill_polygon(std::span<const NodeId> polygon, std::vector<std::array<NodeId, 3>>& out) const {
  std::vector<std::pair<std::size_t, std::size_t>> bases{{0, polygon.size() - 1}};
  while (!bases.empty()) {
    const auto [first, last] = bases.back();
    bases.pop_back();
    if (last - first < 2) continue;
    const NodeId a = polygon[first], b = polygon[last];
    std::size_t apex = first + 1;
    for (std::size_t i = first + 2; i < last; ++i) {
      if (incircle(point(a), point(b), point(polygon[apex]), point(polygon[i])) > 0) apex = i;
    }
    CURVETET_CHECK(orient2d(point(a), point(b), point(polygon[apex])) > 0);
    out.push_back({a, b, polygon[apex]});
    bases.emplace_back(apex, last);
    bases.emplace_back(first, apex);
  }
}

void FaceMesh::recover_edge(NodeId a, NodeId b, std::vector<TriangleId>& made) {
  if (find_edge(a, b)) return;
  std::vector<TriangleId> cavity;
  star(a, cavity);
  FaceEdge crossed;
  for (const TriangleId t : cavity) {
    const FaceTriangle& f = triangles_[t];
    const int i = f.node[0] == a ? 0 : f.node[1] == a ? 1 : 2;
    const Vec2 right = point(f.node[next(i)]), left = point(f.node[previous(i)]);
    if (orient2d(point(a), right, point(b)) > 0 && orient2d(point(a), left, point(b)) < 0) crossed = {t, i};
  }
  cavity.clear();
  CURVETET_CHECK(crossed.triangle.valid());

  // Chains run from a to b on each side of the constraint.
  std::vector<NodeId> left{a}, right{a};
  left.push_back(ends(crossed)[1]);
  right.push_back(ends(crossed)[0]);
  cavity.push_back(crossed.triangle);
  for (;;) {
    CURVETET_CHECK(!is_constrained(crossed) && !on_boundary(crossed));
    const FaceEdge m = mirror(crossed);
    cavity.push_back(m.triangle);
    const NodeId apex = triangles_[m.triangle].node[m.local];
    if (apex == b) break;
    const int side = orient2d(point(a), point(b), point(apex));
    CURVETET_CHECK(side != 0);
    (side > 0 ? left : right).push_back(apex);
    // m is (left, right) seen from its triangle: the next edge is opposite the end that the constraint leaves behind.
    crossed = {m.triangle, side > 0 ? next(m.local) : previous(m.local)};
  }
  left.push_back(b);
  right.push_back(b);
  std::reverse(right.begin(), right.end());
  std::vector<std::array<NodeId, 3>> fill;
  fill_polygon(left, fill);
  fill_polygon(right, fill);
  replace_cavity(cavity, fill, made);
}

// The fill covers exactly the cavity. Constraints within the cavity, on which the fill's triangles meet, stay
// constraints.
void FaceMesh::replace_cavity(std::vector<TriangleId>& cavity, std::span<const std::array<NodeId, 3>> fill,
                              std::vector<TriangleId>& made) {
  std::sort(cavity.begin(), cavity.end());
  std::vector<RimEdge> rim;
  for (const TriangleId t : cavity) {
    for (int i = 0; i < 3; ++i) {
      const FaceEdge beyond = across({t, i});
      const bool outer = !std::binary_search(cavity.begin(), cavity.end(), beyond.triangle);
      if (!outer && !is_constrained({t, i})) continue;
      const auto [a, b] = ends({t, i});
      rim.push_back({a, b, beyond, outer, triangles_[t].use[i]});
    }
  }
  std::sort(rim.begin(), rim.end());
  for (const TriangleId t : cavity) remove_triangle(t);

  std::vector<MadeEdge> edges;
  for (const std::array<NodeId, 3>& f : fill) {
    const TriangleId t = add_triangle(f[0], f[1], f[2]);
    made.push_back(t);
    for (int i = 0; i < 3; ++i) edges.push_back({f[next(i)], f[previous(i)], {t, i}});
  }
  std::sort(edges.begin(), edges.end());
  for (const MadeEdge& e : edges) {
    const RimEdge* r = find_directed(rim, e.a, e.b);
    if (r) triangles_[e.edge.triangle].use[e.edge.local] = r->use;
    if (r && r->outer) {
      link(e.edge, r->beyond);
      continue;
    }
    const MadeEdge* twin = find_directed(edges, e.b, e.a);
    CURVETET_CHECK(twin != nullptr);
    triangles_[e.edge.triangle].neighbour[e.edge.local] = twin->edge.triangle;
  }
}

}  // namespace curvetet
