// The march works on nodes of the chart, not on vertices: a seam vertex is two nodes, so that an edge of the chart's
// border is external (one triangle) and any other internal (two), with no special case for seams and poles, and
// condition 4 is one exact orientation in the chart. Rejected: the paper's three closest-point probes for the side of a
// seam.
//
// After the march the holes of t_ps (connected sets of missing triangles) are judged one by one: a hole has been
// closed when as many marked facets with the same chart area lie in it, since over fixed nodes and border the number of
// triangles is fixed (Euler). What does not close keeps its triangles of t_ps.
#include "boundary/march.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <set>

#include "boundary/criteria.h"
#include "boundary/refine_surface.h"
#include "predicates/predicates.h"
#include "quality/measures.h"

namespace curvetet {

namespace {

using NodePair = std::pair<NodeId, NodeId>;
NodePair ordered(NodeId a, NodeId b) { return a < b ? NodePair{a, b} : NodePair{b, a}; }

/// Sine of a triangle's least angle, below which it counts as flat: half a degree.
constexpr double kFlatSine = 0.0087;

class March {
 public:
  March(const Conjoint& conjoint, FaceId face)
      : conjoint_(conjoint), tets_(*conjoint.tets()), face_(face), mesh_(conjoint.boundary().faces[face]) {}

  MarchResult run() {
    seed();
    if (result_.missing.empty()) {
      result_.complete = true;
      return result_;
    }
    collect_nodes();
    advance();
    judge_holes();
    return result_;
  }

 private:
  struct EdgeState {
    int count = 0;
    int required = 2;
    std::array<std::uint32_t, 2> triangles{};  // numbers of marked triangles
  };

  bool usable(VertexId a, VertexId b, VertexId c) const {
    const auto facet = tets_.find_facet(a, b, c);
    if (!facet) return false;
    const FaceId owner = tets_.complex().locked_face(*facet);
    return !owner.valid() || owner == face_;
  }

  // Looks at t_ps alone first: most faces of most bodies need no march, and no maps.
  void seed() {
    std::vector<std::pair<FacetKey, TriangleId>> present;
    std::vector<TriangleId> collapsed;
    for (std::size_t i = 0; i < mesh_.triangle_slots(); ++i) {
      const TriangleId id(i);
      if (!mesh_.triangle(id).alive()) continue;
      const std::array<VertexId, 3> v = mesh_.vertices(id);
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
        collapsed.push_back(id);
        continue;
      }
      ++result_.total;
      if (usable(v[0], v[1], v[2]))
        present.emplace_back(facet_key(v[0], v[1], v[2]), id);
      else
        result_.missing.push_back(id);
    }
    std::sort(present.begin(), present.end());
    for (std::size_t i = 0; i < present.size(); ++i)
      if (i > 0 && present[i].first == present[i - 1].first) result_.missing.push_back(present[i].second);
    std::sort(result_.missing.begin(), result_.missing.end());
    result_.seeds = result_.total - result_.missing.size();
    if (!result_.missing.empty()) mark_present(present, collapsed);
  }

  void mark_present(const std::vector<std::pair<FacetKey, TriangleId>>& present,
                    const std::vector<TriangleId>& collapsed) {
    for (std::size_t i = 0; i < mesh_.triangle_slots(); ++i)
      if (mesh_.triangle(TriangleId(i)).alive()) require_edges(mesh_.triangle(TriangleId(i)));
    for (TriangleId id : collapsed) mark(mesh_.triangle(id).node);
    for (std::size_t i = 0; i < present.size(); ++i)
      if (i == 0 || present[i].first != present[i - 1].first) mark(mesh_.triangle(present[i].second).node);
    seed_count_ = marked_.size();
  }

  void require_edges(const FaceTriangle& t) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!t.neighbour[k].valid()) edges_[ordered(t.node[(k + 1) % 3], t.node[(k + 2) % 3])].required = 1;
  }

  void mark(const NodeTriple& nodes) {
    const auto number = static_cast<std::uint32_t>(marked_.size());
    marked_.push_back(nodes);
    for (std::size_t k = 0; k < 3; ++k) {
      EdgeState& e = edges_[ordered(nodes[k], nodes[(k + 1) % 3])];
      if (e.count < 2) e.triangles[static_cast<std::size_t>(e.count)] = number;
      ++e.count;
      node_edges_[nodes[k]].insert(nodes[(k + 1) % 3]);
      node_edges_[nodes[(k + 1) % 3]].insert(nodes[k]);
    }
  }

  void collect_nodes() {
    for (std::size_t n = 0; n < mesh_.node_count(); ++n)
      if (mesh_.triangle_at(NodeId(n)).valid()) nodes_of_[mesh_.node(NodeId(n)).vertex].push_back(NodeId(n));
  }

  bool edge_full(NodeId a, NodeId b) const {
    const auto found = edges_.find(ordered(a, b));
    return found != edges_.end() && found->second.count >= found->second.required;
  }

  // Requirement VI: every edge of marked triangles at the node has all its triangles.
  bool node_full(NodeId n) const {
    const auto found = node_edges_.find(n);
    if (found == node_edges_.end() || found->second.empty()) return false;
    return std::all_of(found->second.begin(), found->second.end(), [&](NodeId m) { return edge_full(n, m); });
  }

  void advance() {
    std::deque<std::uint32_t> list;
    for (std::uint32_t i = 0; i < marked_.size(); ++i)
      if (has_open_edge(i)) list.push_back(i);
    std::size_t since_progress = 0;
    while (!list.empty() && since_progress <= list.size()) {
      const std::uint32_t t = list.front();
      list.pop_front();
      const std::size_t before = marked_.size();
      extend(t);
      for (std::size_t k = before; k < marked_.size(); ++k) list.push_back(static_cast<std::uint32_t>(k));
      if (has_open_edge(t)) list.push_back(t);
      since_progress = marked_.size() > before ? 0 : since_progress + 1;
    }
    for (std::uint32_t t : list) note_stuck(t);
  }

  bool has_open_edge(std::uint32_t t) const {
    const NodeTriple& n = marked_[t];
    return !edge_full(n[0], n[1]) || !edge_full(n[1], n[2]) || !edge_full(n[2], n[0]);
  }

  void note_stuck(std::uint32_t t) {
    const NodeTriple n = marked_[t];
    for (std::size_t k = 0; k < 3; ++k)
      if (!edge_full(n[k], n[(k + 1) % 3])) result_.stuck.push_back({n[k], n[(k + 1) % 3], n[(k + 2) % 3]});
  }

  void extend(std::uint32_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const NodeTriple n = marked_[t];
      const NodeId m = n[k], o = n[(k + 1) % 3];
      if (edge_full(m, o)) continue;
      NodeId only;
      if (candidates(m, o, only) == 1) mark({o, m, only});
    }
  }

  // Facets around the edge that satisfy conditions 1-4; the marked triangle lies to the left of m -> o, a candidate to
  // the right.
  int candidates(NodeId m, NodeId o, NodeId& only) {
    const VertexId vm = mesh_.node(m).vertex, vo = mesh_.node(o).vertex;
    const auto edge = tets_.find_edge(vm, vo);
    if (!edge) return 0;
    tets_.ring(*edge, ring_);
    apexes_.clear();
    for (TetId t : ring_)
      for (VertexId v : tets_.complex().vertices(t))
        if (v != vm && v != vo && v != kInfinite) apexes_.push_back(v);
    std::sort(apexes_.begin(), apexes_.end());
    apexes_.erase(std::unique(apexes_.begin(), apexes_.end()), apexes_.end());
    int count = 0;
    for (VertexId v : apexes_) {
      const NodeId c = candidate_node(m, o, v);
      if (!c.valid() || !usable(vm, vo, v)) continue;
      ++count;
      only = c;
    }
    return count;
  }

  NodeId candidate_node(NodeId m, NodeId o, VertexId v) const {
    const auto nodes = nodes_of_.find(v);
    if (nodes == nodes_of_.end()) return {};
    const Vec2 qm = mesh_.node(m).q, qo = mesh_.node(o).q, middle = 0.5 * (qm + qo);
    NodeId best;
    for (NodeId c : nodes->second) {
      if (orient2d(qo, qm, mesh_.node(c).q) <= 0) continue;
      if (node_full(c) || edge_full(m, c) || edge_full(o, c) || against_normal(o, m, c)) continue;
      if (!best.valid() || distance(mesh_.node(c).q, middle) < distance(mesh_.node(best).q, middle)) best = c;
    }
    return best;
  }

  // More than 75 degrees off the surface's normal: no facet of this face.
  bool against_normal(NodeId a, NodeId b, NodeId c) const {
    const VertexStore& vertices = conjoint_.vertices();
    const Vec3 pa = vertices.position(mesh_.node(a).vertex), pb = vertices.position(mesh_.node(b).vertex),
               pc = vertices.position(mesh_.node(c).vertex);
    const Vec3 normal = normalized(cross(pb - pa, pc - pa));
    const Vec2 q = (1.0 / 3) * (mesh_.node(a).q + mesh_.node(b).q + mesh_.node(c).q);
    const Vec3 surface = conjoint_.model().faces[face_].surface->normal(mesh_.chart.to_uv(q));
    return norm2(surface) > 0 && dot(normal, surface) < std::cos(75 * std::numbers::pi / 180);
  }

  double area(const NodeTriple& n) const {
    const Vec2 a = mesh_.node(n[0]).q;
    return 0.5 * cross(mesh_.node(n[1]).q - a, mesh_.node(n[2]).q - a);
  }

  // Numbers the connected sets of missing triangles; constrained edges separate them.
  std::map<TriangleId, std::uint32_t> number_holes() const {
    std::map<TriangleId, std::uint32_t> hole;
    std::uint32_t next = 0;
    const std::set<TriangleId> missing(result_.missing.begin(), result_.missing.end());
    for (TriangleId start : result_.missing) {
      if (hole.count(start)) continue;
      std::vector<TriangleId> stack{start};
      hole[start] = next;
      while (!stack.empty()) {
        const FaceTriangle& t = mesh_.triangle(stack.back());
        stack.pop_back();
        for (std::size_t k = 0; k < 3; ++k) {
          const TriangleId n = t.neighbour[k];
          if (t.use[k] >= 0 || !n.valid() || !missing.count(n) || hole.count(n)) continue;
          hole[n] = next;
          stack.push_back(n);
        }
      }
      ++next;
    }
    return hole;
  }

  struct Hole {
    double area = 0, marked_area = 0;
    std::size_t triangles = 0;
    std::vector<NodeTriple> marked;
    std::vector<TriangleId> old;
  };

  void judge_holes() {
    const auto number = number_holes();
    std::map<std::uint32_t, Hole> holes;
    for (const auto& [t, h] : number) {
      holes[h].area += area(mesh_.triangle(t).node);
      holes[h].old.push_back(t);
      ++holes[h].triangles;
    }
    for (std::size_t i = seed_count_; i < marked_.size(); ++i) {
      const NodeTriple& n = marked_[i];
      const Vec2 q = (1.0 / 3) * (mesh_.node(n[0]).q + mesh_.node(n[1]).q + mesh_.node(n[2]).q);
      const auto at = mesh_.locate(mesh_.chart.to_chart(mesh_.chart.to_uv(q)), mesh_.triangle_at(n[0]));
      const auto found = at ? number.find(*at) : number.end();
      if (found == number.end()) continue;
      holes[found->second].marked.push_back(n);
      holes[found->second].marked_area += area(n);
    }
    result_.complete = true;
    result_.triangles.assign(marked_.begin(), marked_.begin() + static_cast<std::ptrdiff_t>(seed_count_));
    for (auto& [h, hole] : holes) settle(hole);
  }

  void settle(const Hole& hole) {
    const bool closed = hole.marked.size() == hole.triangles && all_edges_full(hole.marked) &&
                        std::abs(hole.area - hole.marked_area) <= 1e-9 * hole.area && !flatter(hole) && !folds(hole) &&
                        !crowds(hole);
    if (closed) {
      result_.triangles.insert(result_.triangles.end(), hole.marked.begin(), hole.marked.end());
      return;
    }
    result_.complete = false;
    for (TriangleId t : hole.old) result_.triangles.push_back(mesh_.triangle(t).node);
  }

  /// Would the hole get a triangle as flat as an ear cut from a polygon of a curve's segments, where it has none now?
  /// The facets of a tetrahedralization that is no longer Delaunay, after flips, can be such.
  bool flatter(const Hole& hole) const {
    double now = kFlatSine, then = kFlatSine;
    for (TriangleId t : hole.old) now = std::min(now, least_sine(mesh_.triangle(t).node));
    for (const NodeTriple& n : hole.marked) then = std::min(then, least_sine(n));
    return then < 0.5 * now;
  }

  /// Would a facet be folded against the surface it is nearest to, as one that spans half a turn of a cylinder?
  bool folds(const Hole& hole) const {
    return std::any_of(hole.marked.begin(), hole.marked.end(),
                       [&](const NodeTriple& n) { return facing_at_foot(conjoint_, face_, n) < kFolded; });
  }

  /// Would an edge of the hole be an edge of another face, too, though it is no segment? Four facets would meet there.
  bool crowds(const Hole& hole) const {
    return std::any_of(hole.marked.begin(), hole.marked.end(), [&](const NodeTriple& n) {
      for (std::size_t k = 0; k < 3; ++k)
        if (is_edge_elsewhere(mesh_.node(n[k]).vertex, mesh_.node(n[(k + 1) % 3]).vertex)) return true;
      return false;
    });
  }

  bool is_edge_elsewhere(VertexId a, VertexId b) const {
    if (a == b || conjoint_.segment_edge(a, b).valid()) return false;
    const std::vector<FaceId>&of_a = conjoint_.faces_of(a), &of_b = conjoint_.faces_of(b);
    return std::any_of(of_a.begin(), of_a.end(), [&](FaceId other) {
      if (other == face_ || std::find(of_b.begin(), of_b.end(), other) == of_b.end()) return false;
      const FaceMesh& mesh = conjoint_.boundary().faces[other];
      for (NodeId m : mesh.nodes_of(a))
        for (NodeId n : mesh.nodes_of(b))
          if (mesh.find_edge(m, n)) return true;
      return false;
    });
  }

  double least_sine(const NodeTriple& n) const {
    const auto at = [&](std::size_t k) { return conjoint_.vertices().position(mesh_.node(n[k]).vertex); };
    return triangle_least_sine(at(0), at(1), at(2));
  }

  bool all_edges_full(const std::vector<NodeTriple>& triangles) const {
    return std::all_of(triangles.begin(), triangles.end(), [&](const NodeTriple& n) {
      return edge_full(n[0], n[1]) && edge_full(n[1], n[2]) && edge_full(n[2], n[0]);
    });
  }

  const Conjoint& conjoint_;
  const Tetrahedralization& tets_;
  FaceId face_;
  const FaceMesh& mesh_;
  MarchResult result_;
  std::vector<NodeTriple> marked_;
  std::size_t seed_count_ = 0;
  std::map<NodePair, EdgeState> edges_;
  std::map<NodeId, std::set<NodeId>> node_edges_;
  std::map<VertexId, std::vector<NodeId>> nodes_of_;
  std::vector<TetId> ring_;
  std::vector<VertexId> apexes_;
};

}  // namespace

MarchResult march_face(const Conjoint& conjoint, FaceId face) { return March(conjoint, face).run(); }

}  // namespace curvetet
