// Insertion of a node by splitting what contains it, then Lawson's flips. Of a mesh that satisfies the criterion only
// edges opposite the new node can violate it then, and each flip adds an edge at that node, so the loop ends for any
// criterion, transitive or not. A cavity (Bowyer-Watson) needs the criterion to make star-shaped cavities, which a
// varying metric does not.
#include <algorithm>

#include "planar/corners.h"
#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet {

PlanarRefusal FaceMesh::judge_insert(Vec2 q, TriangleId triangle) const {
  if (triangle.value() >= triangles_.size() || !triangles_[triangle].alive()) return PlanarRefusal::outside;
  const FaceTriangle& f = triangles_[triangle];
  PlanarRefusal found = PlanarRefusal::none;
  for (int i = 0; i < 3; ++i) {
    if (point(f.node[i]) == q) return PlanarRefusal::duplicate;
    const int side = orient2d(point(f.node[next(i)]), point(f.node[previous(i)]), q);
    if (side < 0) return PlanarRefusal::outside;
    if (side == 0 && f.use[i] != -1) found = PlanarRefusal::on_constraint;
  }
  return found;
}

NodeId FaceMesh::insert(VertexId vertex, Vec2 q, TriangleId triangle, const FlipWanted& wanted,
                        std::vector<TriangleId>& changed) {
  changed.clear();
  if (judge_insert(q, triangle) != PlanarRefusal::none) return NodeId();
  const NodeId n = add_node(vertex, q);
  place(n, triangle, changed);
  if (!wanted) return n;
  flip_star(n, changed, wanted);
  // The edges opposite the node were asked for, and nothing next to them has changed since; but flips at a pole were
  // not.
  for (const TriangleId t : changed) {
    await({t, 1});
    if (touches_pole({t, 0})) await({t, 0});
  }
  restore_awaiting(wanted, changed);
  return n;
}

// The new triangles have the node at local index 0 and are the whole fan around it.
void FaceMesh::place(NodeId n, TriangleId t, std::vector<TriangleId>& fan) {
  const FaceTriangle& f = triangles_[t];
  for (int i = 0; i < 3; ++i) {
    if (orient2d(point(f.node[next(i)]), point(f.node[previous(i)]), point(n)) == 0) {
      place_on_edge(n, {t, i}, fan);
      return;
    }
  }
  place_in_triangle(n, t, fan);
}

void FaceMesh::place_in_triangle(NodeId n, TriangleId t, std::vector<TriangleId>& fan) {
  const FaceTriangle old = triangles_[t];
  remove_triangle(t);
  std::array<TriangleId, 3> made;  // made[i] replaces node i of the old triangle
  for (int i = 0; i < 3; ++i) made[i] = add_triangle(n, old.node[next(i)], old.node[previous(i)]);
  for (int i = 0; i < 3; ++i) {
    FaceTriangle& f = triangles_[made[i]];
    f.neighbour = {old.neighbour[i], made[next(i)], made[previous(i)]};
    f.use[0] = old.use[i];
    fan.push_back(made[i]);
  }
  // The first new triangle took the old one's slot: what points to that slot but belongs elsewhere is turned around.
  for (const int i : {0, 1, 2}) relink(old.neighbour[i], t, made[i]);
}

// The neighbours are found before anything changes: one triangle may border both sides of the edge, and slots are
// reused.
void FaceMesh::place_on_edge(NodeId n, FaceEdge e, std::vector<TriangleId>& fan) {
  const FaceTriangle near = triangles_[e.triangle];
  const int i = e.local;
  const NodeId a = near.node[next(i)], b = near.node[previous(i)], c = near.node[i];
  const FaceEdge beyond_bc = across({e.triangle, next(i)}), beyond_ca = across({e.triangle, previous(i)});
  const FaceEdge m = across(e);
  const bool both_sides = m.triangle.valid();
  const FaceTriangle far = both_sides ? triangles_[m.triangle] : FaceTriangle{};
  const int j = m.local;
  const FaceEdge beyond_ad = both_sides ? across({m.triangle, next(j)}) : FaceEdge{};
  const FaceEdge beyond_db = both_sides ? across({m.triangle, previous(j)}) : FaceEdge{};
  remove_triangle(e.triangle);
  if (both_sides) remove_triangle(m.triangle);

  const TriangleId bc = add_triangle(n, b, c), ca = add_triangle(n, c, a);
  triangles_[bc].use = {near.use[next(i)], -1, near.use[i]};
  triangles_[ca].use = {near.use[previous(i)], near.use[i], -1};
  link({bc, 0}, beyond_bc);
  link({ca, 0}, beyond_ca);
  link({bc, 1}, {ca, 2});
  fan.insert(fan.end(), {bc, ca});
  if (near.use[i] != -1) ++constrained_;
  if (!both_sides) return;

  const NodeId d = far.node[j];
  const TriangleId ad = add_triangle(n, a, d), db = add_triangle(n, d, b);
  triangles_[ad].use = {far.use[next(j)], -1, far.use[j]};
  triangles_[db].use = {far.use[previous(j)], far.use[j], -1};
  link({ad, 0}, beyond_ad);
  link({db, 0}, beyond_db);
  link({ad, 1}, {db, 2});
  link({ca, 1}, {ad, 2});
  link({db, 1}, {bc, 2});
  fan.insert(fan.end(), {ad, db});
  if (far.use[j] != -1) ++constrained_;
}

// Triangles of the fan keep n at local index 0; what a flip makes is appended and looked at in turn.
void FaceMesh::flip_star(NodeId n, std::vector<TriangleId>& fan, const FlipWanted& wanted) {
  std::vector<TriangleId>& stack = scratch_;
  stack.assign(fan.begin(), fan.end());
  while (!stack.empty()) {
    const FaceEdge e{stack.back(), 0};
    const FaceTriangle& f = triangles_[e.triangle];
    if (f.use[0] != -1 || !f.neighbour[0].valid() || !can_flip(e)) {
      stack.pop_back();
      continue;
    }
    const FaceEdge m = mirror(e);
    if (!wanted(f.node[1], f.node[2], n, triangles_[m.triangle].node[m.local])) {
      stack.pop_back();
      continue;
    }
    const std::array<TriangleId, 2> made = flip_edge(e);  // the first takes the slot on the stack and in the fan
    stack.push_back(made[1]);
    fan.push_back(made[1]);
  }
}

bool FaceMesh::can_flip(FaceEdge e) const {
  const FaceTriangle& f = triangles_[e.triangle];
  if (!f.neighbour[e.local].valid() || f.use[e.local] != -1) return false;
  const FaceEdge m = mirror(e);
  const Vec2 a = point(f.node[next(e.local)]), b = point(f.node[previous(e.local)]), c = point(f.node[e.local]);
  const Vec2 d = point(triangles_[m.triangle].node[m.local]);
  return orient2d(c, a, d) > 0 && orient2d(c, d, b) > 0;
}

// (c,a,b) and (d,b,a) become (c,a,d), in the first one's slot, and (c,d,b), in the other's; c comes first in both.
std::array<TriangleId, 2> FaceMesh::flip_edge(FaceEdge e) {
  const FaceEdge m = mirror(e);
  const TriangleId t = e.triangle, s = m.triangle;
  const FaceTriangle near = triangles_[t], far = triangles_[s];
  const int i = e.local, j = m.local;
  const NodeId a = near.node[next(i)], b = near.node[previous(i)], c = near.node[i], d = far.node[j];
  FaceTriangle &f = triangles_[t], &g = triangles_[s];
  f.node = {c, a, d};
  f.neighbour = {far.neighbour[next(j)], s, near.neighbour[previous(i)]};
  f.use = {far.use[next(j)], -1, near.use[previous(i)]};
  g.node = {c, d, b};
  g.neighbour = {far.neighbour[previous(j)], near.neighbour[next(i)], t};
  g.use = {far.use[previous(j)], near.use[next(i)], -1};
  relink(far.neighbour[next(j)], s, t);
  relink(near.neighbour[next(i)], t, s);
  node_triangle_[a] = t;
  node_triangle_[b] = s;
  node_triangle_[c] = t;
  node_triangle_[d] = t;
  return {t, s};
}

bool FaceMesh::flip(FaceEdge edge) {
  if (!has_edge(edge) || !can_flip(edge)) return false;
  flip_edge(edge);
  return true;
}

// Adds what restoring touches to the triangles changed so far.
void FaceMesh::restore_around(std::vector<TriangleId>& changed, const FlipWanted& wanted) {
  for (const TriangleId t : changed) await_edges(t);
  restore_awaiting(wanted, changed);
}

void FaceMesh::restore(std::span<const TriangleId> from, const FlipWanted& wanted, std::vector<TriangleId>& changed) {
  for (const TriangleId t : from) await_edges(t);
  changed.clear();
  restore_awaiting(wanted, changed);
}

void FaceMesh::restore(const FlipWanted& wanted, std::vector<TriangleId>& changed) {
  for (std::uint32_t k = 0; k < triangles_.size(); ++k) {
    const FaceTriangle& f = triangles_[TriangleId(k)];
    for (int i = 0; f.alive() && i < 3; ++i) {
      if (f.neighbour[i].valid() && f.neighbour[i] > TriangleId(k)) await({TriangleId(k), i});
    }
  }
  changed.clear();
  restore_awaiting(wanted, changed);
}

void FaceMesh::await_edges(TriangleId t) {
  for (int i = 0; triangles_[t].alive() && i < 3; ++i) await({t, i});
}

void FaceMesh::await(FaceEdge e) {
  const auto [a, b] = ends(e);
  awaiting_.push_back({e, a, b});
}

// A criterion that is not transitive could flip for ever: the number of flips is bounded by a multiple of the edges.
void FaceMesh::restore_awaiting(const FlipWanted& wanted, std::vector<TriangleId>& changed) {
  auto budget = static_cast<std::ptrdiff_t>(64 + 32 * awaiting_.size());
  while (!awaiting_.empty() && budget > 0) {
    const AwaitingEdge w = awaiting_.back();
    awaiting_.pop_back();
    const FaceTriangle& f = triangles_[w.edge.triangle];
    // An edge that moved to another triangle was pushed again by the flip that moved it.
    if (f.node[next(w.edge.local)] != w.a || f.node[previous(w.edge.local)] != w.b) continue;
    const auto asked = [&](FaceEdge m) {
      return wanted(w.a, w.b, f.node[w.edge.local], triangles_[m.triangle].node[m.local]);
    };
    if (!can_flip(w.edge) || !asked(mirror(w.edge))) {
      for (const TriangleId t : flip_at_pole(w.edge, wanted)) {
        changed.push_back(t);
        await_edges(t);
        --budget;
      }
      continue;
    }
    const auto [t, s] = flip_edge(w.edge);
    --budget;
    changed.insert(changed.end(), {t, s});
    await({t, 0});
    await({t, 2});
    await({s, 0});
    await({s, 1});
  }
  awaiting_.clear();
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
}

}  // namespace curvetet
