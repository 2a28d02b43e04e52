// Validity of a face mesh. Links, orientation and constraints are local. That no two triangles overlap then follows
// from the boundary: triangles that all turn left cover a point as often as the boundary winds around it, so it is
// enough that boundary edges do not cross and that one triangle at each boundary loop overlaps no other.
#include <algorithm>

#include "planar/corners.h"
#include "planar/face_mesh.h"
#include "planar/loops.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

using Points = std::array<Vec2, 3>;

bool separated_by_side(const Points& t, const Points& s) {
  for (int i = 0; i < 3; ++i) {
    const auto beyond = [&](Vec2 p) { return orient2d(t[next(i)], t[previous(i)], p) <= 0; };
    if (beyond(s[0]) && beyond(s[1]) && beyond(s[2])) return true;
  }
  return false;
}

bool boxes_overlap(const Points& t, const Points& s) {
  const auto low = [](const Points& p, double Vec2::*x) { return std::min({p[0].*x, p[1].*x, p[2].*x}); };
  const auto high = [](const Points& p, double Vec2::*x) { return std::max({p[0].*x, p[1].*x, p[2].*x}); };
  return low(t, &Vec2::x) < high(s, &Vec2::x) && low(s, &Vec2::x) < high(t, &Vec2::x) &&
         low(t, &Vec2::y) < high(s, &Vec2::y) && low(s, &Vec2::y) < high(t, &Vec2::y);
}

}  // namespace

class FaceMeshChecker {
 public:
  explicit FaceMeshChecker(const FaceMesh& mesh) : mesh_(mesh) {}

  std::vector<std::string> run() {
    for (std::uint32_t t = 0; t < mesh_.triangles_.size(); ++t) {
      if (mesh_.triangles_[TriangleId(t)].alive()) check_nodes(TriangleId(t));
    }
    if (!broken_.empty()) return broken_;  // what follows walks along links
    for (std::uint32_t t = 0; t < mesh_.triangles_.size(); ++t) {
      if (mesh_.triangles_[TriangleId(t)].alive()) check_edges(TriangleId(t));
    }
    if (!broken_.empty()) return broken_;
    check_counts();
    check_stars();
    check_boundary();
    check_cover();
    return broken_;
  }

 private:
  void report(const std::string& what, std::uint32_t where) { broken_.push_back(what + " " + std::to_string(where)); }

  Points points(TriangleId t) const {
    const FaceTriangle& f = mesh_.triangles_[t];
    return {mesh_.point(f.node[0]), mesh_.point(f.node[1]), mesh_.point(f.node[2])};
  }

  void check_nodes(TriangleId t) {
    const FaceTriangle& f = mesh_.triangles_[t];
    for (const NodeId n : f.node) {
      if (n.value() >= mesh_.nodes_.size()) return report("unknown node in triangle", t.value());
    }
    const Points p = points(t);
    if (orient2d(p[0], p[1], p[2]) <= 0) report("does not turn left: triangle", t.value());
    for (const TriangleId n : f.neighbour) {
      if (n.valid() && (n.value() >= mesh_.triangles_.size() || !mesh_.triangles_[n].alive())) {
        report("neighbour missing at triangle", t.value());
      }
    }
  }

  void check_edges(TriangleId t) {
    const FaceTriangle& f = mesh_.triangles_[t];
    for (int i = 0; i < 3; ++i) {
      if (f.use[i] != -1) ++constrained_;
      if (!f.neighbour[i].valid()) {
        ++boundary_edges_;
        if (f.use[i] == -1) report("free edge on the boundary at triangle", t.value());
        continue;
      }
      const FaceTriangle& g = mesh_.triangles_[f.neighbour[i]];
      bool reciprocal = false;
      for (int j = 0; j < 3; ++j) {
        if (g.node[next(j)] != f.node[previous(i)] || g.node[previous(j)] != f.node[next(i)]) continue;
        reciprocal = g.neighbour[j] == t;
        if ((g.use[j] == -1) != (f.use[i] == -1)) report("constrained on one side only: triangle", t.value());
      }
      if (!reciprocal) report("link not reciprocal at triangle", t.value());
    }
  }

  void check_counts() {
    if (constrained_ != mesh_.constrained_)
      report("constrained edges lost or won, now", static_cast<std::uint32_t>(constrained_));
    std::size_t dead = 0;
    for (const FaceTriangle& f : mesh_.triangles_) dead += !f.alive();
    if (dead != mesh_.free_.size()) report("free slots miscounted, now", static_cast<std::uint32_t>(dead));
    if (boundary_edges_ != mesh_.boundary_.size()) {
      report("boundary edges not indexed, now", static_cast<std::uint32_t>(boundary_edges_));
    }
  }

  void check_stars() {
    IndexedVector<NodeId, std::size_t> degree(mesh_.nodes_.size(), 0);
    for (const FaceTriangle& f : mesh_.triangles_) {
      for (const NodeId n : f.node) {
        if (f.alive()) ++degree[n];
      }
    }
    std::vector<TriangleId> around;
    for (std::uint32_t k = 0; k < mesh_.nodes_.size(); ++k) {
      const NodeId n(k);
      const TriangleId at = mesh_.node_triangle_[n];
      if (at.valid() != (degree[n] > 0)) report("triangle of the node unknown: node", k);
      if (!at.valid()) continue;
      const FaceTriangle& f = mesh_.triangles_[at];
      if (std::find(f.node.begin(), f.node.end(), n) == f.node.end()) {
        report("not in its triangle: node", k);
        continue;
      }
      mesh_.star(n, around);
      if (around.size() != degree[n]) report("several fans around node", k);
      const std::vector<NodeId> carriers = mesh_.nodes_of(mesh_.nodes_[n].vertex);
      if (std::find(carriers.begin(), carriers.end(), n) == carriers.end()) report("not found by its vertex: node", k);
    }
  }

  template <class Visit>
  void for_each_boundary_edge(Visit&& visit) const {
    for (std::uint32_t t = 0; t < mesh_.triangles_.size(); ++t) {
      const FaceTriangle& f = mesh_.triangles_[TriangleId(t)];
      for (int i = 0; f.alive() && i < 3; ++i) {
        if (!f.neighbour[i].valid()) visit(FaceEdge{TriangleId(t), i});
      }
    }
  }

  void check_boundary() {
    LoopGraph graph;
    graph.nodes = mesh_.nodes_;
    for_each_boundary_edge([&](FaceEdge e) {
      const auto [a, b] = mesh_.ends(e);
      graph.segments.push_back({a, b, 0, 0, 0, false});
      bool indexed = false;
      mesh_.boundary_.near(mesh_.point(a), mesh_.point(a), [&, u = a, v = b](SegmentGrid::Entry entry) {
        indexed = indexed || entry == SegmentGrid::Entry{u.value(), v.value()};
      });
      if (!indexed) report("boundary edge not indexed at triangle", e.triangle.value());
    });
    for (const LoopFault& fault : find_crossings(graph)) broken_.push_back("boundary edges " + fault.what);
  }

  /// The next boundary edge of the same fan, after the edge's end.
  FaceEdge following(FaceEdge e) const {
    FaceEdge f{e.triangle, next(e.local)};
    while (!mesh_.on_boundary(f)) {
      const FaceEdge m = mesh_.mirror(f);
      f = {m.triangle, next(m.local)};
    }
    return f;
  }

  void check_cover() {
    std::vector<bool> seen(3 * mesh_.triangles_.size(), false);
    const auto place = [](FaceEdge e) {
      return 3 * std::size_t{e.triangle.value()} + static_cast<std::size_t>(e.local);
    };
    for_each_boundary_edge([&](FaceEdge start) {
      if (seen[place(start)]) return;
      for (FaceEdge e = start; !seen[place(e)]; e = following(e)) seen[place(e)] = true;
      check_alone(start.triangle);
    });
  }

  void check_alone(TriangleId t) {
    const Points p = points(t);
    for (std::uint32_t k = 0; k < mesh_.triangles_.size(); ++k) {
      const TriangleId s(k);
      if (s == t || !mesh_.triangles_[s].alive()) continue;
      const Points q = points(s);
      if (boxes_overlap(p, q) && !separated_by_side(p, q) && !separated_by_side(q, p)) {
        report("overlaps triangle " + std::to_string(k) + ": triangle", t.value());
      }
    }
  }

  const FaceMesh& mesh_;
  std::vector<std::string> broken_;
  std::size_t constrained_ = 0, boundary_edges_ = 0;
};

std::vector<std::string> FaceMesh::check() const { return FaceMeshChecker(*this).run(); }

}  // namespace curvetet
