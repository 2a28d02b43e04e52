// The cavity of a vertex: grown by the perturbed insphere test, then shrunk where locks, kept segments or earlier flips
// have made the tetrahedralization other than Delaunay.
//
// Shrinking takes away every tet with a boundary facet that the point does not see strictly from inside. "Where an
// invisible facet is on the boundary, its tet must go" is closed under union, so what is left is the one largest
// star-shaped subset, whatever the order. Two more rules can only be met by choice, and take the tet found last: no
// vertex and no kept segment may vanish in the cavity's interior. Each step removes a tet, so it ends.
//
// The base never goes: the finite tets that contain the point, or the ghosts whose hull facets it lies strictly beyond
// (leaving one out would make the hull overlap itself). If one has to go, the insertion is refused.
//
// What is left is connected: from a generic point of a part without the base, the way to p would leave the part through
// a facet of its boundary that p does not see, or at p itself, or through the hull into a ghost of the base.
//
// A locked facet is boundary from both its sides, also where the flood came around its rim; one of the two sides is
// invisible, or the point is in its plane and both go. Facets of ghosts through infinity need no test: beyond the hull
// the base is exact, and a ghost coplanar with the point stays only together with its finite neighbour, whose own
// facets then put the point on the right side of the hull's edges.
#include <algorithm>

#include "spatial/kernel.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

class CavitySearch {
 public:
  CavitySearch(const Tetrahedralization& mesh, VertexId vertex)
      : mesh_(mesh), complex_(mesh.complex_), sites_(mesh.sites()), vertex_(vertex), p_(mesh.position(vertex)) {
    cavity_.vertex = vertex;
  }

  Cavity run(TetId hint) {
    const TetId first = mesh_.locate(p_, hint);
    complex_.start_flood();
    if (!first.valid()) {
      cavity_.refusal = Refusal::outside;
    } else {
      cavity_.refusal = find_base(first);
    }
    if (cavity_.ok()) {
      grow();
      shrink();
    }
    if (!cavity_.ok()) {
      cavity_.tets.clear();
      cavity_.boundary.clear();
    }
    return std::move(cavity_);
  }

 private:
  bool inside(TetId t) const { return complex_.flood_state(t) >= kernel::kInside; }
  bool base(TetId t) const { return complex_.flood_state(t) == kernel::kBase; }

  void add_base(TetId t) {
    if (inside(t)) return;
    complex_.set_flood_state(t, kernel::kBase);
    cavity_.tets.push_back(t);
  }

  Refusal find_base(TetId first) {
    for (const VertexId w : complex_.vertices(first)) {
      if (w != kInfinite && mesh_.position(w) == p_) return Refusal::duplicate;
    }
    add_base(first);
    bool on_lock = false;
    const bool beyond = complex_.is_ghost(first);
    for (std::size_t k = 0; k < cavity_.tets.size(); ++k) {
      const TetId t = cavity_.tets[k];
      if (beyond) {
        add_visible_ghosts(t);
      } else if (!complex_.is_ghost(t)) {
        if (on_kept_segment(t)) return Refusal::on_kept_segment;
        on_lock = add_tets_that_touch(t) || on_lock;
      }
    }
    return on_lock ? Refusal::on_locked_facet : Refusal::none;
  }

  /// The ghosts that see the point strictly are connected: the hull is convex.
  void add_visible_ghosts(TetId t) {
    const int infinite = kernel::infinite_local(complex_, t);
    for (int i = 0; i < 4; ++i) {
      if (i == infinite) continue;
      const TetId next = complex_.neighbour(t, i);
      if (!inside(next) && kernel::side(complex_, sites_, next, kernel::infinite_local(complex_, next), p_) > 0) {
        add_base(next);
      }
    }
  }

  /// Adds the neighbours across facets that hold the point; true if one of these facets is locked.
  bool add_tets_that_touch(TetId t) {
    bool on_lock = false;
    for (int i = 0; i < 4; ++i) {
      if (kernel::side(complex_, sites_, t, i, p_) != 0) continue;
      on_lock = on_lock || complex_.is_locked({t, i});
      add_base(complex_.neighbour(t, i));
    }
    return on_lock;
  }

  /// The point, which lies in the closed tet, lies on a kept edge of it.
  bool on_kept_segment(TetId t) const {
    if (mesh_.kept_.empty()) return false;
    std::array<bool, 4> zero{};
    for (int i = 0; i < 4; ++i) zero[static_cast<std::size_t>(i)] = kernel::side(complex_, sites_, t, i, p_) == 0;
    for (std::size_t e = 0; e < 6; ++e) {
      const std::array<int, 2>& opposite = kEdge[5 - e];
      if (!zero[static_cast<std::size_t>(opposite[0])] || !zero[static_cast<std::size_t>(opposite[1])]) continue;
      if (mesh_.is_kept(complex_.vertex(t, kEdge[e][0]), complex_.vertex(t, kEdge[e][1]))) return true;
    }
    return false;
  }

  void grow() {
    for (std::size_t k = 0; k < cavity_.tets.size(); ++k) {
      const TetId t = cavity_.tets[k];
      for (int i = 0; i < 4; ++i) {
        const TetId next = complex_.neighbour(t, i);
        if (complex_.flood_state(next) != 0 || complex_.is_locked({t, i})) continue;
        const bool conflict = kernel::in_conflict(complex_, sites_, next, p_, vertex_);
        complex_.set_flood_state(next, conflict ? kernel::kInside : kernel::kOutside);
        if (conflict) cavity_.tets.push_back(next);
      }
    }
  }

  bool is_boundary(TetId t, int i) const { return complex_.is_locked({t, i}) || !inside(complex_.neighbour(t, i)); }

  void shrink() {
    do {
      remove_invisible();
      if (!cavity_.ok()) return;
      collect();
    } while (remove_swallower() && cavity_.ok());
  }

  /// The tet leaves the cavity, or the insertion is refused.
  void exclude(TetId t) {
    if (base(t)) cavity_.refusal = Refusal::locked_cavity;
    complex_.set_flood_state(t, kernel::kOutside);
  }

  void remove_invisible() {
    queue_ = cavity_.tets;
    for (std::size_t k = 0; k < queue_.size() && cavity_.ok(); ++k) {
      const TetId t = queue_[k];
      if (!inside(t) || sees_all_boundary(t)) continue;
      exclude(t);
      for (int i = 0; i < 4; ++i) {
        if (inside(complex_.neighbour(t, i))) queue_.push_back(complex_.neighbour(t, i));
      }
    }
  }

  bool sees_all_boundary(TetId t) const {
    const int infinite = kernel::infinite_local(complex_, t);
    for (int i = 0; i < 4; ++i) {
      if ((infinite >= 0 && i != infinite) || !is_boundary(t, i)) continue;
      if (kernel::side(complex_, sites_, t, i, p_) <= 0) return false;
    }
    return true;
  }

  /// Lists again what is in the cavity, and its boundary.
  void collect() {
    std::vector<TetId>& tets = cavity_.tets;
    std::erase_if(tets, [&](TetId t) { return !inside(t); });
    cavity_.boundary.clear();
    for (const TetId t : tets) {
      for (int i = 0; i < 4; ++i) {
        if (is_boundary(t, i)) cavity_.boundary.push_back({t, i});
      }
    }
  }

  /// Takes the last found tet around a vertex or kept segment that would vanish out of the cavity; false if none would.
  bool remove_swallower() {
    kernel::VertexSet& on_boundary = mesh_.boundary_vertices_;
    on_boundary.start(mesh_.vertices().size());
    for (const TetFacet& f : cavity_.boundary) {
      for (const VertexId v : complex_.facet_vertices(f)) {
        if (v != kInfinite) on_boundary.insert(v);
      }
    }
    for (auto t = cavity_.tets.rbegin(); t != cavity_.tets.rend(); ++t) {
      for (const VertexId v : complex_.vertices(*t)) {
        const bool swallowed = v != kInfinite && !on_boundary.contains(v);
        if (swallowed) return take_out(v, v);
      }
      if (mesh_.kept_.empty()) continue;
      for (const auto& [i, j] : kEdge) {
        const VertexId a = complex_.vertex(*t, i);
        const VertexId b = complex_.vertex(*t, j);
        if (is_kept_edge(a, b) && !on_boundary_facet(a, b)) return take_out(a, b);
      }
    }
    return false;
  }

  bool is_kept_edge(VertexId a, VertexId b) const {
    return a != kInfinite && b != kInfinite && mesh_.kept_degree_[a] > 0 && mesh_.kept_degree_[b] > 0 &&
           mesh_.is_kept(a, b);
  }

  bool on_boundary_facet(VertexId a, VertexId b) const {
    return std::any_of(cavity_.boundary.begin(), cavity_.boundary.end(), [&](const TetFacet& f) {
      const int i = complex_.local(f.tet, a);
      const int j = complex_.local(f.tet, b);
      return i >= 0 && j >= 0 && i != f.local && j != f.local;
    });
  }

  /// Excludes the last tet outside the base that has both vertices; refuses if there is none.
  bool take_out(VertexId a, VertexId b) {
    const auto found = std::find_if(cavity_.tets.rbegin(), cavity_.tets.rend(), [&](TetId t) {
      return !base(t) && !complex_.is_ghost(t) && complex_.local(t, a) >= 0 && complex_.local(t, b) >= 0;
    });
    if (found == cavity_.tets.rend()) {
      cavity_.refusal = Refusal::locked_cavity;
      return true;
    }
    exclude(*found);
    return true;
  }

  const Tetrahedralization& mesh_;
  const TetComplex& complex_;
  const kernel::Sites sites_;
  const VertexId vertex_;
  const Vec3 p_;  ///< where the vertex is
  Cavity cavity_;
  std::vector<TetId> queue_;
};

Cavity Tetrahedralization::find_cavity(VertexId vertex, TetId hint) const {
  return CavitySearch(*this, vertex).run(hint);
}

}  // namespace curvetet
