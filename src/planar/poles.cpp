// An edge to a pole is one edge in space but may be several in the chart, one to each image of the pole, with triangles
// over the pole, which have no area in space, between them. The nodes around a pole are a chain in the chart, its ring;
// which of two neighbours in the ring has a triangle over the pole is of no account in space. So the edge to the pole
// is flipped by taking its node out of the ring, and the edge of two neighbours by putting a node between them, each
// with a new choice of images. Rejected: ordinary flips one after the other, which need each triangle on the way to
// turn left.
#include <algorithm>
#include <cmath>

#include "planar/corners.h"
#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet {

// The local index of the third node of a triangle over a pole. Two nodes of one vertex within the domain, as on both
// sides of a seam, are no pole.
std::optional<int> FaceMesh::pole_apex(TriangleId t) const {
  const FaceTriangle& f = triangles_[t];
  for (int k = 0; k < 3; ++k)
    if (!f.neighbour[k].valid() && nodes_[f.node[next(k)]].vertex == nodes_[f.node[previous(k)]].vertex) return k;
  return std::nullopt;
}

// From a triangle over the pole through all with the same apex, to its left or to its right with the pole ahead; ends
// at the edge of the first triangle that is over no pole, without a triangle at a constraint or at another pole.
FaceEdge FaceMesh::pass_over_pole(TriangleId t, bool left, PoleRun& run) const {
  for (;;) {
    const int apex = *pole_apex(t);
    const FaceTriangle& f = triangles_[t];
    run.cavity.push_back(t);
    if (left)
      run.images.push_back(f.node[previous(apex)]);
    else
      run.images.insert(run.images.begin(), f.node[next(apex)]);
    const FaceEdge out{t, left ? next(apex) : previous(apex)};
    if (f.use[out.local] != -1 || !f.neighbour[out.local].valid()) return {};
    const FaceEdge beyond = mirror(out);
    const auto its_apex = pole_apex(beyond.triangle);
    if (!its_apex) return beyond;
    if (triangles_[beyond.triangle].node[*its_apex] != f.node[apex]) return {};
    t = beyond.triangle;
  }
}

// Takes out the cavity and joins a ring, from right to left, to the images; `fill` is what is to lie below the ring.
// Nothing is changed, and nothing returned, where no triangles that turn left are found.
std::vector<TriangleId> FaceMesh::join_to_pole(std::span<const NodeId> ring, PoleRun& run,
                                               std::vector<std::array<NodeId, 3>> fill) {
  const std::vector<NodeId>& images = run.images;
  const Vec2 along = point(images.back()) - point(images.front());
  std::size_t from = 0;
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
    const Vec2 middle = 0.5 * (point(ring[k]) + point(ring[k + 1]));
    const auto off = [&](std::size_t m) { return std::abs(dot(point(images[m]) - middle, along)); };
    std::size_t best = images.size();
    for (std::size_t m = from; m < images.size(); ++m) {
      if (orient2d(point(ring[k]), point(images[m]), point(ring[k + 1])) <= 0) continue;
      if (best == images.size() || off(m) < off(best)) best = m;
    }
    if (best == images.size()) return {};
    for (; from < best; ++from) fill.push_back({ring[k], images[from], images[from + 1]});
    fill.push_back({ring[k], images[best], ring[k + 1]});
  }
  for (; from + 1 < images.size(); ++from) fill.push_back({ring.back(), images[from], images[from + 1]});
  const bool valid = std::all_of(fill.begin(), fill.end(), [this](const std::array<NodeId, 3>& f) {
    return orient2d(point(f[0]), point(f[1]), point(f[2])) > 0;
  });
  std::vector<TriangleId> made;
  if (valid) replace_cavity(run.cavity, fill, made);
  return made;
}

// The apex of a triangle over the pole leaves the ring: its neighbours there, u and s, are joined.
std::vector<TriangleId> FaceMesh::leave_ring(TriangleId over, const FlipWanted& wanted) {
  const int apex = *pole_apex(over);
  const NodeId c = triangles_[over].node[apex];
  PoleRun run;
  const FaceEdge right = pass_over_pole(over, false, run);
  run.cavity.erase(run.cavity.begin());  // the pass to the left begins there, too
  const FaceEdge left = pass_over_pole(over, true, run);
  if (!right.triangle.valid() || !left.triangle.valid()) return {};
  const NodeId u = triangles_[right.triangle].node[right.local], s = triangles_[left.triangle].node[left.local];
  // The chart's edges are askew, to either side of the one in space: what only some of them ask for is not asked for.
  if (!wanted(c, run.images.front(), s, u) || !wanted(c, run.images.back(), s, u)) return {};
  run.cavity.insert(run.cavity.end(), {right.triangle, left.triangle});
  return join_to_pole(std::array{u, s}, run, {{c, u, s}});
}

// The node below the edge of two neighbours of the ring, s and u, comes between them.
std::vector<TriangleId> FaceMesh::join_ring(FaceEdge below_pole, const FlipWanted& wanted) {
  const FaceTriangle& f = triangles_[below_pole.triangle];
  const int i = below_pole.local;
  const NodeId pole = f.node[i], s = f.node[next(i)], u = f.node[previous(i)];
  const FaceEdge below = mirror(below_pole);
  const NodeId c = triangles_[below.triangle].node[below.local];
  const auto over = [this](FaceEdge side) {
    const TriangleId n = triangles_[side.triangle].neighbour[side.local];
    return is_constrained(side) || !n.valid() || !pole_apex(n) ? TriangleId() : n;
  };
  const TriangleId left = over({below_pole.triangle, previous(i)}), right = over({below_pole.triangle, next(i)});
  if ((!left.valid() && !right.valid()) || pole_apex(below.triangle)) return {};
  if (!wanted(s, u, pole, c)) return {};
  PoleRun run;
  run.images.push_back(pole);
  if (left.valid()) pass_over_pole(left, true, run);
  if (right.valid()) pass_over_pole(right, false, run);
  run.cavity.insert(run.cavity.end(), {below_pole.triangle, below.triangle});
  return join_to_pole(std::array{u, c, s}, run, {});
}

// A triangle over a pole has nodes at the pole, and what joins a ring is opposite one.
bool FaceMesh::touches_pole(FaceEdge edge) const {
  if (poles_.empty() || is_constrained(edge) || on_boundary(edge)) return false;
  const auto at_pole = [this](NodeId n) {
    return std::find(poles_.begin(), poles_.end(), nodes_[n].vertex) != poles_.end();
  };
  const FaceTriangle& f = triangles_[edge.triangle];
  if (at_pole(f.node[0]) || at_pole(f.node[1]) || at_pole(f.node[2])) return true;
  const FaceEdge m = mirror(edge);
  return at_pole(triangles_[m.triangle].node[m.local]);
}

std::vector<TriangleId> FaceMesh::flip_at_pole(FaceEdge edge, const FlipWanted& wanted) {
  if (!touches_pole(edge)) return {};
  const FaceEdge m = mirror(edge);
  // The edge of the pole itself is constrained: one of a triangle over the pole leads to the pole from its apex.
  for (const FaceEdge e : {edge, m})
    if (pole_apex(e.triangle)) return leave_ring(e.triangle, wanted);
  for (const FaceEdge e : {edge, m}) {
    std::vector<TriangleId> made = join_ring(e, wanted);
    if (!made.empty()) return made;
  }
  return {};
}

}  // namespace curvetet
