// Every condition is tested on every tet or facet, with nothing shared with the code that builds them but the
// predicates.
#include "spatial/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "predicates/predicates.h"

namespace curvetet {

namespace {

constexpr std::size_t kMostFindings = 20;

class Checker {
 public:
  Checker(const Tetrahedralization& mesh, bool delaunay) : mesh_(mesh), complex_(mesh.complex()), delaunay_(delaunay) {}

  std::vector<std::string> run() {
    for (std::size_t slot = 0; slot < complex_.slots() && findings_.size() < kMostFindings; ++slot) {
      const TetId t(slot);
      if (!complex_.is_alive(t) || !check_vertices(t) || !check_links(t)) continue;
      if (complex_.is_ghost(t)) {
        check_hull(t);
      } else {
        check_positive(t);
      }
      check_locks(t);
      collect_edges(t);
      if (delaunay_) check_delaunay(t);
    }
    check_vertex_tets();
    check_kept_segments();
    check_hull_is_sphere();
    return std::move(findings_);
  }

 private:
  static std::string text(VertexId v) { return v == kInfinite ? "infinite" : std::to_string(v.value()); }
  std::string text(TetId t) const {
    const TetComplex::Vertices& v = complex_.vertices(t);
    return fmt::format("tet {} ({} {} {} {})", t.value(), text(v[0]), text(v[1]), text(v[2]), text(v[3]));
  }
  void find(const std::string& what) {
    if (findings_.size() < kMostFindings) findings_.push_back(what);
  }

  bool check_vertices(TetId t) {
    std::set<VertexId> distinct;
    for (const VertexId v : complex_.vertices(t)) {
      distinct.insert(v);
      if (v == kInfinite) continue;
      if (v.value() >= mesh_.vertices().size()) {
        find(text(t) + " has a vertex that is not in the store");
        return false;
      }
      used_.insert(v);
    }
    if (distinct.size() == 4) return true;
    find(text(t) + " has a vertex twice");
    return false;
  }

  bool check_links(TetId t) {
    for (int i = 0; i < 4; ++i) {
      const TetId next = complex_.neighbour(t, i);
      if (!next.valid() || next.value() >= complex_.slots() || !complex_.is_alive(next)) {
        find(text(t) + " has no neighbour " + std::to_string(i));
        return false;
      }
      const TetFacet back = complex_.mirror({t, i});
      if (complex_.neighbour(back.tet, back.local) != t) {
        find(text(t) + " is not linked back by " + text(next));
        return false;
      }
      const auto own = complex_.facet_vertices({t, i});
      auto theirs = complex_.facet_vertices(back);
      std::reverse(theirs.begin(), theirs.end());
      const auto first = std::find(theirs.begin(), theirs.end(), own[0]);
      std::rotate(theirs.begin(), first, theirs.end());
      if (own != theirs) {
        find(text(t) + " and " + text(next) + " do not see one facet from its two sides");
        return false;
      }
    }
    return true;
  }

  int orientation(const TetComplex::Vertices& v) const {
    return orient3d(mesh_.position(v[0]), mesh_.position(v[1]), mesh_.position(v[2]), mesh_.position(v[3]));
  }

  void check_positive(TetId t) {
    if (orientation(complex_.vertices(t)) <= 0) find(text(t) + " is not positive");
  }

  /// The apexes of the three ghosts around must not lie strictly beyond the hull facet.
  void check_hull(TetId ghost) {
    ++ghosts_;
    const auto infinite = static_cast<std::size_t>(complex_.local(ghost, kInfinite));
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId v = complex_.vertices(ghost)[i];
      if (i == infinite) continue;
      hull_.insert(v);
      const TetFacet across = complex_.mirror({ghost, static_cast<int>(i)});
      const VertexId apex = complex_.vertex(across.tet, across.local);
      if (apex == kInfinite) {
        find(text(ghost) + " has a finite neighbour across an infinite facet");
        continue;
      }
      TetComplex::Vertices moved = complex_.vertices(ghost);
      moved[infinite] = apex;
      const int side = orientation(moved);
      if (side > 0) find("the hull is not convex at " + text(ghost));
      if (side == 0 && delaunay_ && insphere(complex_.neighbour(ghost, static_cast<int>(infinite)), apex) > 0) {
        find("the hull is not Delaunay in its plane at " + text(ghost));
      }
    }
  }

  void check_locks(TetId t) {
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{t, i};
      if (complex_.is_locked(f) != complex_.is_locked(complex_.mirror(f))) {
        find("one side of a facet of " + text(t) + " is locked, the other is not");
      }
      if (!complex_.is_locked(f)) continue;
      if (!complex_.locked_face(f).valid()) find("a locked facet of " + text(t) + " has no face");
      for (const VertexId v : complex_.facet_vertices(f)) {
        if (v == kInfinite) find("an infinite facet of " + text(t) + " is locked");
      }
    }
  }

  void collect_edges(TetId t) {
    for (const auto& [i, j] : kEdge) {
      const VertexId a = complex_.vertex(t, i);
      const VertexId b = complex_.vertex(t, j);
      if (mesh_.is_kept(a, b)) edges_.insert({std::min(a, b), std::max(a, b)});
    }
  }

  int insphere(TetId t, VertexId v) const {
    const TetComplex::Vertices& w = complex_.vertices(t);
    return insphere_perturbed(
        {mesh_.position(w[0]), mesh_.position(w[1]), mesh_.position(w[2]), mesh_.position(w[3]), mesh_.position(v)},
        {w[0], w[1], w[2], w[3], v});
  }

  void check_delaunay(TetId t) {
    if (complex_.is_ghost(t)) return;
    for (int i = 0; i < 4; ++i) {
      const TetFacet back = complex_.mirror({t, i});
      const VertexId apex = complex_.vertex(back.tet, back.local);
      if (apex == kInfinite || complex_.is_locked({t, i})) continue;
      if (insphere(t, apex) > 0) find(text(t) + " has vertex " + text(apex) + " in its sphere");
    }
  }

  void check_vertex_tets() {
    for (std::size_t k = 0; k < mesh_.vertices().size(); ++k) {
      const VertexId v(k);
      if (mesh_.contains(v) != used_.contains(v)) {
        find("vertex " + text(v) + (used_.contains(v) ? " has no tet" : " is in no tet but has one"));
      } else if (mesh_.contains(v)) {
        const TetId t = mesh_.tet_of(v);
        if (!complex_.is_alive(t) || complex_.local(t, v) < 0) find("the tet of vertex " + text(v) + " is wrong");
      }
    }
  }

  void check_kept_segments() {
    for (const auto& [a, b] : mesh_.kept_segments()) {
      if (!edges_.contains({a, b})) find("the kept segment " + text(a) + " " + text(b) + " is not an edge");
    }
  }

  void check_hull_is_sphere() {
    if (complex_.alive() > 0 && ghosts_ + 4 != 2 * hull_.size()) find("the hull is not a sphere");
  }

  const Tetrahedralization& mesh_;
  const TetComplex& complex_;
  const bool delaunay_;
  std::set<VertexId> used_, hull_;
  std::set<std::array<VertexId, 2>> edges_;  // kept segments that were seen
  std::size_t ghosts_ = 0;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> check_tetrahedralization(const Tetrahedralization& mesh, bool delaunay) {
  return Checker(mesh, delaunay).run();
}

}  // namespace curvetet
