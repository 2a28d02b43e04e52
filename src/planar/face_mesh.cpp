// Queries and the links of a face mesh. Neighbours are kept per triangle; a node knows one triangle of its fan, and the
// few nodes where the domain touches itself (pinched: two fans) are listed, so that everything else is a walk around a
// node. Ghost triangles outside of the domain would make every star a cycle, but every caller would have to skip them.
#include "planar/face_mesh.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "planar/corners.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

// A hint farther away than this many triangles is worth less than a look at some triangles all over the mesh.
constexpr std::size_t kHintedSteps = 64;

int local_of(const FaceTriangle& t, NodeId n) {
  return t.node[0] == n ? 0 : t.node[1] == n ? 1 : t.node[2] == n ? 2 : -1;
}

}  // namespace

std::size_t FaceMesh::triangle_count() const { return triangles_.size() - free_.size(); }

std::array<VertexId, 3> FaceMesh::vertices(TriangleId t) const {
  const FaceTriangle& f = triangles_[t];
  return {nodes_[f.node[0]].vertex, nodes_[f.node[1]].vertex, nodes_[f.node[2]].vertex};
}

std::vector<NodeId> FaceMesh::nodes_of(VertexId v) const {
  std::vector<NodeId> found = index_.find(v);
  std::erase_if(found, [this](NodeId n) { return !node_triangle_[n].valid(); });
  return found;
}

TriangleId FaceMesh::triangle_at(NodeId n) const { return node_triangle_[n]; }

void FaceMesh::star(NodeId n, std::vector<TriangleId>& out) const {
  out.clear();
  const TriangleId start = node_triangle_[n];
  if (!start.valid()) return;
  if (std::binary_search(pinched_.begin(), pinched_.end(), n)) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (local_of(triangles_[TriangleId(t)], n) >= 0) out.push_back(TriangleId(t));
    }
    return;
  }
  TriangleId first = start;  // turn clockwise to the boundary, or once around
  do {
    const FaceTriangle& f = triangles_[first];
    const TriangleId before = f.neighbour[previous(local_of(f, n))];
    if (!before.valid()) break;
    first = before;
  } while (first != start);
  TriangleId t = first;
  do {
    out.push_back(t);
    const FaceTriangle& f = triangles_[t];
    t = f.neighbour[next(local_of(f, n))];
  } while (t.valid() && t != first);
}

std::optional<FaceEdge> FaceMesh::find_edge(NodeId a, NodeId b) const {
  std::vector<TriangleId> around;
  star(a, around);
  std::optional<FaceEdge> reversed;
  for (const TriangleId t : around) {
    const int i = local_of(triangles_[t], a);
    if (triangles_[t].node[next(i)] == b) return FaceEdge{t, previous(i)};
    if (triangles_[t].node[previous(i)] == b) reversed = FaceEdge{t, next(i)};
  }
  return reversed;
}

std::array<NodeId, 2> FaceMesh::ends(FaceEdge e) const {
  const FaceTriangle& t = triangles_[e.triangle];
  return {t.node[next(e.local)], t.node[previous(e.local)]};
}

bool FaceMesh::has_edge(FaceEdge e) const {
  return e.triangle.value() < triangles_.size() && triangles_[e.triangle].alive() && e.local >= 0 && e.local < 3;
}

bool FaceMesh::contains(TriangleId t, Vec2 q) const {
  const FaceTriangle& f = triangles_[t];
  const Vec2 a = point(f.node[0]), b = point(f.node[1]), c = point(f.node[2]);
  return orient2d(a, b, q) >= 0 && orient2d(b, c, q) >= 0 && orient2d(c, a, q) >= 0;
}

// A walk by orientation can cycle in a triangulation that is not Delaunay; the edge it tries first changes with the
// step, and the number of steps is bounded by the number of triangles.
FaceMesh::WalkEnd FaceMesh::walk(Vec2 q, TriangleId from, Stop stop, std::size_t steps) const {
  TriangleId t = from, came_from;
  for (std::size_t step = 0; step < steps; ++step) {
    const FaceTriangle& f = triangles_[t];
    std::optional<FaceEdge> blocked;
    TriangleId onward;
    for (int k = 0; k < 3 && !onward.valid(); ++k) {
      const int i = static_cast<int>((step + static_cast<std::size_t>(k)) % 3);
      if (came_from.valid() && f.neighbour[i] == came_from) continue;
      if (orient2d(point(f.node[next(i)]), point(f.node[previous(i)]), q) >= 0) continue;
      if (!f.neighbour[i].valid() || (stop == Stop::at_constraints && f.use[i] != -1)) {
        blocked = FaceEdge{t, i};
      } else {
        onward = f.neighbour[i];
      }
    }
    if (!onward.valid()) {
      if (blocked) return {std::nullopt, blocked};
      return {t, std::nullopt};
    }
    came_from = t;
    t = onward;
  }
  return {};
}

FaceMesh::WalkEnd FaceMesh::walk(Vec2 q, TriangleId from) const {
  return walk(q, from, Stop::at_constraints, longest_walk());
}

// The nearest of about the cube root of all triangles (Mücke, Saias and Zhu, "Fast randomized point location", 1999),
// taken at equal steps of the numbering instead of at random.
TriangleId FaceMesh::nearby_triangle(Vec2 q) const {
  const auto samples = static_cast<std::size_t>(std::cbrt(static_cast<double>(triangles_.size()))) + 1;
  const std::size_t stride = std::max<std::size_t>(1, triangles_.size() / samples);
  TriangleId best;
  double best_distance = 0;
  for (std::size_t i = 0; i < triangles_.size(); i += stride) {
    std::size_t k = i;
    while (k < triangles_.size() && !triangles_[TriangleId(k)].alive()) ++k;
    if (k == triangles_.size()) break;
    const double d = norm2(point(triangles_[TriangleId(k)].node[0]) - q);
    if (!best.valid() || d < best_distance) {
      best = TriangleId(k);
      best_distance = d;
    }
  }
  return best;
}

// Which boundary edges the horizontal ray from q to the right meets tells whether q is inside, and the nearest of them
// has a triangle from which the ray sees q.
FaceMesh::Ray FaceMesh::cast(Vec2 q) const {
  struct Hit {
    double x;
    SegmentGrid::Entry entry;
    bool operator<(const Hit& h) const { return std::tie(x, entry) < std::tie(h.x, h.entry); }
    bool operator==(const Hit& h) const { return entry == h.entry; }
  };
  std::vector<Hit> hits;
  Ray ray;
  boundary_.near(q, {1, q.y}, [&](SegmentGrid::Entry e) {
    const Vec2 a = point(NodeId(e.a)), b = point(NodeId(e.b));
    if (q.y < std::min(a.y, b.y) || q.y > std::max(a.y, b.y) || q.x > std::max(a.x, b.x)) return;
    const int side = orient2d(a, b, q);
    if (side == 0 && q.x >= std::min(a.x, b.x)) ray.touched = e;
    const bool upward = a.y <= q.y && q.y < b.y, downward = b.y <= q.y && q.y < a.y;
    if ((upward && side > 0) || (downward && side < 0)) {
      hits.push_back({a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x), e});
    }
  });
  std::sort(hits.begin(), hits.end());
  hits.erase(std::unique(hits.begin(), hits.end()), hits.end());
  for (const Hit& h : hits) ray.winding += point(NodeId(h.entry.a)).y < point(NodeId(h.entry.b)).y ? 1 : -1;
  if (!hits.empty()) ray.first = hits.front().entry;
  return ray;
}

std::optional<TriangleId> FaceMesh::locate(Vec2 q, TriangleId hint) const {
  if (hint.value() < triangles_.size() && triangles_[hint].alive()) {
    const WalkEnd end = walk(q, hint, Stop::at_boundary, kHintedSteps);
    if (end.triangle) return end.triangle;
  }
  const TriangleId from = nearby_triangle(q);
  if (!from.valid()) return std::nullopt;
  const WalkEnd end = walk(q, from, Stop::at_boundary, longest_walk());
  if (end.triangle) return end.triangle;
  const Ray ray = cast(q);
  const std::optional<SegmentGrid::Entry> seen = ray.touched ? ray.touched : ray.first;
  if (!seen || (!ray.touched && ray.winding == 0)) return std::nullopt;
  const std::optional<FaceEdge> edge = find_edge(NodeId(seen->a), NodeId(seen->b));
  CURVETET_CHECK(edge.has_value());
  const WalkEnd again = walk(q, edge->triangle, Stop::at_boundary, longest_walk());
  return again.triangle ? again.triangle : scan(q);
}

std::optional<TriangleId> FaceMesh::scan(Vec2 q) const {
  for (std::uint32_t k = 0; k < triangles_.size(); ++k) {
    const FaceTriangle& f = triangles_[TriangleId(k)];
    if (!f.alive()) continue;
    const Vec2 a = point(f.node[0]), b = point(f.node[1]), c = point(f.node[2]);
    const bool boxed = q.x >= std::min({a.x, b.x, c.x}) && q.x <= std::max({a.x, b.x, c.x}) &&
                       q.y >= std::min({a.y, b.y, c.y}) && q.y <= std::max({a.y, b.y, c.y});
    if (boxed && contains(TriangleId(k), q)) return TriangleId(k);
  }
  return std::nullopt;
}

FaceEdge FaceMesh::mirror(FaceEdge e) const {
  const TriangleId n = triangles_[e.triangle].neighbour[e.local];
  const NodeId start = triangles_[e.triangle].node[previous(e.local)];
  return {n, previous(local_of(triangles_[n], start))};
}

FaceEdge FaceMesh::across(FaceEdge e) const { return on_boundary(e) ? FaceEdge{} : mirror(e); }

NodeId FaceMesh::add_node(VertexId vertex, Vec2 q) {
  const NodeId n = nodes_.push_back({vertex, q});
  node_triangle_.push_back(TriangleId());
  index_.add(vertex, n);
  return n;
}

TriangleId FaceMesh::add_triangle(NodeId a, NodeId b, NodeId c) {
  TriangleId t;
  if (free_.empty()) {
    t = triangles_.push_back({});
  } else {
    t = free_.back();
    free_.pop_back();
  }
  FaceTriangle& f = triangles_[t];
  f = FaceTriangle{};
  f.node = {a, b, c};
  for (const NodeId n : f.node) node_triangle_[n] = t;
  return t;
}

void FaceMesh::remove_triangle(TriangleId t) {
  triangles_[t] = FaceTriangle{};
  free_.push_back(t);
}

void FaceMesh::link(FaceEdge a, FaceEdge b) {
  if (a.triangle.valid()) triangles_[a.triangle].neighbour[a.local] = b.triangle;
  if (b.triangle.valid()) triangles_[b.triangle].neighbour[b.local] = a.triangle;
}

void FaceMesh::relink(TriangleId neighbour, TriangleId from, TriangleId to) {
  if (!neighbour.valid()) return;
  for (TriangleId& n : triangles_[neighbour].neighbour) {
    if (n == from) {
      n = to;
      return;
    }
  }
}

void FaceMesh::find_pinched() {
  pinched_.clear();
  IndexedVector<NodeId, int> starts(nodes_.size(), 0);  // boundary edges that start at the node: one a fan
  for (const FaceTriangle& f : triangles_) {
    for (int i = 0; f.alive() && i < 3; ++i) {
      if (!f.neighbour[i].valid()) ++starts[f.node[next(i)]];
    }
  }
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (starts[NodeId(n)] > 1) pinched_.push_back(NodeId(n));
  }
}

void FaceMesh::index_boundary() {
  Vec2 low{1, 1}, high{-1, -1};
  std::size_t count = 0;
  for (const FaceTriangle& f : triangles_) {
    for (int i = 0; f.alive() && i < 3; ++i) {
      if (f.neighbour[i].valid()) continue;
      ++count;
      const Vec2 q = point(f.node[next(i)]);
      low = {std::min(low.x, q.x), std::min(low.y, q.y)};
      high = {std::max(high.x, q.x), std::max(high.y, q.y)};
    }
  }
  boundary_.reset(low, high, count);
  poles_.clear();
  for (const FaceTriangle& f : triangles_) {
    for (int i = 0; f.alive() && i < 3; ++i) {
      const NodeId a = f.node[next(i)], b = f.node[previous(i)];
      if (f.neighbour[i].valid()) continue;
      boundary_.add({a.value(), b.value()}, point(a), point(b));
      if (nodes_[a].vertex == nodes_[b].vertex) poles_.push_back(nodes_[a].vertex);
    }
  }
  std::sort(poles_.begin(), poles_.end());
  has_tip_ = false;
  constexpr std::size_t kHalfTurn = kPoleSteps / 2;
  for (std::size_t i = kHalfTurn; i < poles_.size(); ++i) has_tip_ = has_tip_ || poles_[i] == poles_[i - kHalfTurn];
  poles_.erase(std::unique(poles_.begin(), poles_.end()), poles_.end());
}

}  // namespace curvetet
