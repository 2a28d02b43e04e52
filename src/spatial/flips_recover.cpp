// Recovery of edges and facets by flips, without points.
//
// What stands in the way of a segment are the facets and edges it crosses; in the way of a triangle, the edges that
// cross it. Each exchange of tets changes that count only by what is inside the exchanged polyhedron, so the change is
// known before it is made. A facet in the way is flipped (2-3), or one of its edges is removed; an edge in the way is
// removed: by dynamic programming over its ring if that has a legal triangulation, else after its ring has been made
// smaller by removing edges from its ends to its ring, recursively (the idea of the n-to-m flip; Si, "TetGen", ACM TOMS
// 2015, section 4). Such a sequence is kept if the count falls at its end and taken back otherwise, and everything is
// taken back if the goal is not reached. The count is a non-negative integer that falls with every kept sequence, and
// the recursion is bounded in depth and in the number of rings it looks at: so recovery ends.
#include <algorithm>
#include <cmath>

#include "predicates/predicates.h"
#include "spatial/flips.h"
#include "spatial/flips_exchange.h"
#include "spatial/flips_ring.h"

namespace curvetet {

namespace {

using flips::Exchange;
using flips::Ring;

/// Rings looked at for one obstacle: bounds the recursion. Deep searches on rings of usual length need a few hundred.
constexpr int kRingBudget = 600;

/// True if v lies on the open segment ab.
bool on_segment(Vec3 v, Vec3 a, Vec3 b) { return collinear(a, b, v) && dot(v - a, b - a) > 0 && dot(v - b, a - b) > 0; }

/// Cost of what a wanted segment crosses.
struct SegmentObstruction {
  const Tetrahedralization& mesh;
  VertexId a, b;
  bool touches(VertexId v) const { return v == a || v == b; }
  int edge(VertexId u, VertexId v) const {
    if (touches(u) || touches(v)) return 0;
    return segments_cross(mesh.position(a), mesh.position(b), mesh.position(u), mesh.position(v));
  }
  int facet(VertexId u, VertexId v, VertexId w) const {
    if (touches(u) || touches(v) || touches(w)) return 0;
    return segment_triangle(mesh.position(a), mesh.position(b), mesh.position(u), mesh.position(v), mesh.position(w)) ==
           SegmentTriangle::crosses;
  }
  double floor() const { return -1; }
  double tet(Vec3 p, Vec3 q, Vec3 r, Vec3 s) const { return flips::volume_over_length(p, q, r, s); }
};

/// Cost of what crosses a wanted triangle.
struct TriangleObstruction {
  const Tetrahedralization& mesh;
  VertexId a, b, c;
  bool touches(VertexId v) const { return v == a || v == b || v == c; }
  int edge(VertexId u, VertexId v) const {
    if (touches(u) || touches(v)) return 0;
    return segment_triangle(mesh.position(u), mesh.position(v), mesh.position(a), mesh.position(b), mesh.position(c)) ==
           SegmentTriangle::crosses;
  }
  int facet(VertexId, VertexId, VertexId) const { return 0; }
  double floor() const { return -1; }
  double tet(Vec3 p, Vec3 q, Vec3 r, Vec3 s) const { return flips::volume_over_length(p, q, r, s); }
};

/// Facets and edges in the way, by their vertices; `hopeless` if a vertex is in the way.
struct Obstacles {
  std::vector<std::array<VertexId, 3>> facets;
  std::vector<std::array<VertexId, 2>> edges;
  bool hopeless = false;
};

/// Removes obstacles under one measure of obstruction; all changes are logged.
template <class Obstruction>
class Remover {
 public:
  Remover(Tetrahedralization& mesh, const Obstruction& obstruction) : mesh_(mesh), obstruction_(obstruction) {}

  /// Removes the edge pq; kept only if the count of obstacles falls.
  bool clear_edge(VertexId p, VertexId q, int depth) {
    return attempt([&] { return remove(p, q, std::nullopt, depth); });
  }
  /// Flips the facet away, or removes one of its edges; kept only if the count of obstacles falls.
  bool clear_facet(const std::array<VertexId, 3>& v, int depth) {
    if (attempt([&] { return flip(v); })) return true;
    for (int d = 0; d <= depth; ++d) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (clear_edge(v[i], v[(i + 1) % 3], d)) return true;
      }
    }
    return false;
  }
  void undo_all() { log_.undo_to(mesh_, 0); }

 private:
  template <class Change>
  bool attempt(const Change& change) {
    const std::size_t mark = log_.size();
    budget_ = kRingBudget;
    balance_ = 0;
    if (change() && balance_ < 0) return true;
    log_.undo_to(mesh_, mark);
    return false;
  }

  bool flip(const std::array<VertexId, 3>& v) {
    const TetComplex& complex = mesh_.complex();
    const auto facet = mesh_.find_facet(v[0], v[1], v[2]);
    if (!facet || complex.is_locked(*facet)) return false;
    const TetFacet other = complex.mirror(*facet);
    if (complex.is_ghost(facet->tet) || complex.is_ghost(other.tet)) return false;
    const VertexId d = complex.vertex(facet->tet, facet->local), e = complex.vertex(other.tet, other.local);
    const auto f = complex.facet_vertices(*facet);
    Exchange exchange;
    exchange.old_tets.push_back(facet->tet);
    exchange.old_tets.push_back(other.tet);
    balance_ += obstruction_.edge(d, e) - obstruction_.facet(f[0], f[1], f[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId a = f[i], b = f[(i + 1) % 3];
      if (orient3d(mesh_.position(a), mesh_.position(b), mesh_.position(e), mesh_.position(d)) <= 0) return false;
      exchange.new_tets.push_back({a, b, e, d});
      balance_ += obstruction_.facet(a, d, e);
    }
    if (!flips::is_free(complex, exchange)) return false;
    log_.commit(mesh_, exchange);
    return true;
  }

  /// The ring of pq if the edge may go, else nothing.
  std::optional<Ring> free_ring(VertexId p, VertexId q) {
    if (mesh_.is_kept(p, q)) return std::nullopt;
    const auto edge = mesh_.find_edge(p, q);
    if (!edge) return std::nullopt;
    auto ring = flips::ring_of(mesh_.complex(), *edge, flips::kMaxRing);
    if (!ring) return std::nullopt;
    Exchange exchange;
    for (TetId t : ring->tets) exchange.old_tets.push_back(t);
    if (!flips::is_free(mesh_.complex(), exchange)) return std::nullopt;
    return ring;
  }

  /// Removes the edge pq. With an ear, so that the ring of the edge from p to the ear, and of that from q, gets shorter
  /// by one.
  bool remove(VertexId p, VertexId q, std::optional<VertexId> ear, int depth) {
    const std::size_t mark = log_.size();
    const int balance = balance_;
    if (remove_at_once(p, q, ear)) return true;
    while (depth > 0 && budget_ > 0) {
      if (!shorten(p, q, ear, depth)) break;
      if (remove_at_once(p, q, ear)) return true;
    }
    log_.undo_to(mesh_, mark);
    balance_ = balance;
    return false;
  }

  bool remove_at_once(VertexId p, VertexId q, std::optional<VertexId> ear) {
    const auto ring = free_ring(p, q);
    if (!ring || --budget_ < 0) return false;
    std::optional<int> at;
    if (ear) {
      const auto found = std::find(ring->vertices.begin(), ring->vertices.end(), *ear);
      if (found == ring->vertices.end()) return false;
      at = static_cast<int>(found - ring->vertices.begin());
    }
    const auto plan = flips::RingPlanner(mesh_, *ring, obstruction_).plan(at);
    if (!plan) return false;
    balance_ += plan->cost - obstruction_.edge(ring->p, ring->q);
    for (VertexId v : ring->vertices) balance_ -= obstruction_.facet(ring->p, ring->q, v);
    log_.commit(mesh_, flips::exchange_of(*ring, *plan));
    return true;
  }

  /// Makes the ring of pq shorter by one: takes a vertex out of it by removing its edge to p or to q.
  bool shorten(VertexId p, VertexId q, std::optional<VertexId> ear, int depth) {
    const auto ring = free_ring(p, q);
    if (!ring || ring->vertices.size() <= 3) return false;
    for (VertexId v : ring->vertices) {
      if (ear && v == *ear) continue;
      if (remove(p, v, q, depth - 1) || remove(q, v, p, depth - 1)) return true;
      if (budget_ <= 0) return false;
    }
    return false;
  }

  Tetrahedralization& mesh_;
  const Obstruction& obstruction_;
  flips::Log log_;
  int budget_ = 0, balance_ = 0;
};

/// Finds what a segment crosses by following it from tet to tet.
class SegmentWalk {
 public:
  SegmentWalk(const Tetrahedralization& mesh, const SegmentObstruction& segment)
      : mesh_(mesh), complex_(mesh.complex()), segment_(segment) {}

  Obstacles run() {
    mesh_.star(segment_.a, queue_);
    seen_ = queue_;
    std::sort(seen_.begin(), seen_.end());
    for (std::size_t i = 0; i < queue_.size() && !obstacles_.hopeless; ++i) {
      if (!complex_.is_ghost(queue_[i])) examine(queue_[i]);
    }
    return std::move(obstacles_);
  }

 private:
  void examine(TetId t) {
    for (int i = 0; i < 4; ++i) {
      const VertexId w = complex_.vertex(t, i);
      if (!segment_.touches(w) &&
          on_segment(mesh_.position(w), mesh_.position(segment_.a), mesh_.position(segment_.b))) {
        obstacles_.hopeless = true;
      }
      auto f = complex_.facet_vertices({t, i});
      if (segment_.facet(f[0], f[1], f[2]) == 0) continue;
      std::sort(f.begin(), f.end());
      if (std::find(obstacles_.facets.begin(), obstacles_.facets.end(), f) != obstacles_.facets.end()) continue;
      obstacles_.facets.push_back(f);
      visit(complex_.neighbour(t, i));
    }
    for (const auto& [i, j] : kEdge) {
      const VertexId u = complex_.vertex(t, i), v = complex_.vertex(t, j);
      const std::array<VertexId, 2> e{std::min(u, v), std::max(u, v)};
      if (segment_.edge(e[0], e[1]) == 0) continue;
      if (std::find(obstacles_.edges.begin(), obstacles_.edges.end(), e) != obstacles_.edges.end()) continue;
      obstacles_.edges.push_back(e);
      mesh_.ring({t, i, j}, ring_);
      for (TetId r : ring_) visit(r);
    }
  }

  void visit(TetId t) {
    const auto at = std::lower_bound(seen_.begin(), seen_.end(), t);
    if (at != seen_.end() && *at == t) return;
    seen_.insert(at, t);
    queue_.push_back(t);
  }

  const Tetrahedralization& mesh_;
  const TetComplex& complex_;
  const SegmentObstruction& segment_;
  Obstacles obstacles_;
  std::vector<TetId> queue_, seen_, ring_;
};

/// Finds the edges that cross a triangle whose edges exist, from the rings of those on.
class TriangleWalk {
 public:
  TriangleWalk(const Tetrahedralization& mesh, const TriangleObstruction& triangle)
      : mesh_(mesh), complex_(mesh.complex()), triangle_(triangle) {}

  Obstacles run() {
    start(triangle_.a, triangle_.b);
    start(triangle_.b, triangle_.c);
    start(triangle_.c, triangle_.a);
    for (std::size_t i = 0; i < queue_.size() && !obstacles_.hopeless; ++i) {
      if (!complex_.is_ghost(queue_[i])) examine(queue_[i]);
    }
    return std::move(obstacles_);
  }

 private:
  void start(VertexId u, VertexId v) {
    const auto edge = mesh_.find_edge(u, v);
    if (!edge) {
      obstacles_.hopeless = true;
      return;
    }
    mesh_.ring(*edge, ring_);
    for (TetId t : ring_) visit(t);
  }

  bool inside(VertexId w) const {
    const Vec3 a = mesh_.position(triangle_.a), b = mesh_.position(triangle_.b), c = mesh_.position(triangle_.c);
    const Vec3 p = mesh_.position(w);
    if (orient3d(a, b, c, p) != 0) return false;
    for (int axis = 0; axis < 3; ++axis) {
      const int s = orient2d_dropped(a, b, c, axis);
      if (s == 0) continue;
      return orient2d_dropped(a, b, p, axis) * s >= 0 && orient2d_dropped(b, c, p, axis) * s >= 0 &&
             orient2d_dropped(c, a, p, axis) * s >= 0;
    }
    return true;  // the triangle itself is degenerate
  }

  void examine(TetId t) {
    for (int i = 0; i < 4; ++i) {
      const VertexId w = complex_.vertex(t, i);
      if (!triangle_.touches(w) && inside(w)) obstacles_.hopeless = true;
    }
    for (const auto& [i, j] : kEdge) {
      const VertexId u = complex_.vertex(t, i), v = complex_.vertex(t, j);
      const std::array<VertexId, 2> e{std::min(u, v), std::max(u, v)};
      if (triangle_.edge(u, v) == 0) continue;
      if (std::find(obstacles_.edges.begin(), obstacles_.edges.end(), e) != obstacles_.edges.end()) continue;
      obstacles_.edges.push_back(e);
      mesh_.ring({t, i, j}, ring_);
      for (TetId r : ring_) visit(r);
    }
  }

  void visit(TetId t) {
    const auto at = std::lower_bound(seen_.begin(), seen_.end(), t);
    if (at != seen_.end() && *at == t) return;
    seen_.insert(at, t);
    queue_.push_back(t);
  }

  const Tetrahedralization& mesh_;
  const TetComplex& complex_;
  const TriangleObstruction& triangle_;
  Obstacles obstacles_;
  std::vector<TetId> queue_, seen_, ring_;
};

/// Clears one obstacle, the cheap ones first: true if the count fell.
template <class Obstruction>
bool clear_one(Remover<Obstruction>& remover, const Obstacles& obstacles, int depth) {
  for (int d = 0; d <= depth; ++d) {
    for (const auto& f : obstacles.facets) {
      if (remover.clear_facet(f, d)) return true;
    }
    for (const auto& e : obstacles.edges) {
      if (remover.clear_edge(e[0], e[1], d)) return true;
    }
  }
  return false;
}

/// Clears obstacles until none is left or none gives way; takes everything back unless `reached`.
template <class Walk, class Obstruction, class Reached>
bool clear_all(Tetrahedralization& mesh, const Obstruction& obstruction, int depth, const Reached& reached) {
  Remover<Obstruction> remover(mesh, obstruction);
  while (!reached()) {
    const Obstacles obstacles = Walk(mesh, obstruction).run();
    if (obstacles.hopeless || !clear_one(remover, obstacles, depth)) {
      remover.undo_all();
      return false;
    }
  }
  return true;
}

}  // namespace

bool recover_edge_by_flips(Tetrahedralization& mesh, VertexId a, VertexId b, int depth) {
  if (a == b || !mesh.contains(a) || !mesh.contains(b)) return false;
  const SegmentObstruction segment{mesh, a, b};
  return clear_all<SegmentWalk>(mesh, segment, depth, [&] { return mesh.find_edge(a, b).has_value(); });
}

bool recover_facet_by_flips(Tetrahedralization& mesh, VertexId a, VertexId b, VertexId c, int depth) {
  if (a == b || b == c || c == a || !mesh.contains(a) || !mesh.contains(b) || !mesh.contains(c)) return false;
  const TriangleObstruction triangle{mesh, a, b, c};
  return clear_all<TriangleWalk>(mesh, triangle, depth, [&] { return mesh.find_facet(a, b, c).has_value(); });
}

}  // namespace curvetet
