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
#include <bit>

#include "spatial/conflicts.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

class CavitySearch {
 public:
  CavitySearch(const Tetrahedralization& mesh, CavityScratch& scratch, VertexId vertex, Vec3 p, Cavity& cavity)
      : mesh_(mesh),
        complex_(mesh.complex_),
        sites_(mesh.sites()),
        marks_(scratch.marks),
        vertex_(vertex),
        p_(p),
        cavity_(cavity),
        scratch_(scratch),
        queue_(scratch.queue) {
    cavity_.vertex = vertex;
    cavity_.tets.clear();
    cavity_.boundary.clear();
  }

  void run(TetId first) {
    marks_.start();
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
  }

 private:
  bool inside(TetId t) const { return marks_.state(t.value()) >= kernel::kInside; }
  bool base(TetId t) const { return marks_.state(t.value()) == kernel::kBase; }

  void add_base(TetId t) {
    if (inside(t)) return;
    marks_.set(t.value(), kernel::kBase);
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
        const unsigned facets = facets_that_hold_it(t);
        if (on_kept_segment(t, facets)) return Refusal::on_kept_segment;
        on_lock = add_tets_that_touch(t, facets) || on_lock;
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

  /// Of the tet, in whose closure the point lies: a bit each.
  unsigned facets_that_hold_it(TetId t) const {
    unsigned facets = 0;
    for (int i = 0; i < 4; ++i)
      facets |= static_cast<unsigned>(kernel::side(complex_, sites_, t, i, p_) == 0) << static_cast<unsigned>(i);
    return facets;
  }

  /// Adds the neighbours across facets that hold the point; true if one of these facets is locked.
  bool add_tets_that_touch(TetId t, unsigned facets) {
    bool on_lock = false;
    for (; facets != 0; facets &= facets - 1) {
      const int i = std::countr_zero(facets);
      on_lock = on_lock || complex_.is_locked({t, i});
      add_base(complex_.neighbour(t, i));
    }
    return on_lock;
  }

  /// The point lies on a kept edge of the tet.
  bool on_kept_segment(TetId t, unsigned facets) const {
    if (std::popcount(facets) < 2) return false;
    return std::any_of(kEdge.begin(), kEdge.end(), [&](const std::array<int, 2>& edge) {
      const unsigned beside = facets & ~(1U << static_cast<unsigned>(edge[0]) | 1U << static_cast<unsigned>(edge[1]));
      return std::popcount(beside) == 2 && mesh_.is_kept(complex_.vertex(t, edge[0]), complex_.vertex(t, edge[1]));
    });
  }

  /// Its boundary is known with it: what is around a tet is settled when the tet is looked at.
  void grow() {
    for (std::size_t k = 0; k < cavity_.tets.size(); ++k) {
      const TetId t = cavity_.tets[k];
      const std::array<TetId, 4>& neighbours = complex_.neighbours(t);
      unsigned asked = 0;
      for (int i = 0; i < 4; ++i) {
        const bool fresh =
            marks_.state(neighbours[static_cast<std::size_t>(i)].value()) == 0 && !complex_.is_locked({t, i});
        asked |= static_cast<unsigned>(fresh) << static_cast<unsigned>(i);
      }
      if (asked != 0) add_conflicts(neighbours, asked);
      for (int i = 0; i < 4; ++i)
        if (is_boundary(t, i)) cavity_.boundary.push_back({t, i});
    }
  }

  void add_conflicts(const std::array<TetId, 4>& neighbours, unsigned asked) {
    const unsigned conflicts =
        kernel::conflicts_among(complex_, sites_, mesh_.insphere_four_, neighbours, asked, p_, vertex_, 0);
    for (; asked != 0; asked &= asked - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(asked));
      const bool joins = (conflicts >> i & 1U) != 0;
      marks_.set(neighbours[i].value(), joins ? kernel::kInside : kernel::kOutside);
      if (!joins) continue;
      for (const TetId beyond : complex_.neighbours(neighbours[i])) complex_.prefetch(beyond);
      cavity_.tets.push_back(neighbours[i]);
    }
  }

  bool is_boundary(TetId t, int i) const { return complex_.is_locked({t, i}) || !inside(complex_.neighbour(t, i)); }

  void shrink() {
    const bool star_shaped = std::all_of(cavity_.boundary.begin(), cavity_.boundary.end(),
                                         [&](const TetFacet& f) { return is_seen(f.tet, f.local); });
    if (!star_shaped) remove_invisible();
    while (cavity_.ok() && remove_swallower()) {
      if (cavity_.ok()) remove_invisible();
    }
  }

  /// The tet leaves the cavity, or the insertion is refused.
  void exclude(TetId t) {
    if (base(t)) cavity_.refusal = Refusal::locked_cavity;
    marks_.set(t.value(), kernel::kOutside);
  }

  /// Lists again what is left.
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
    if (!cavity_.ok()) return;
    std::erase_if(cavity_.tets, [&](TetId t) { return !inside(t); });
    collect_boundary();
  }

  bool sees_all_boundary(TetId t) const {
    for (int i = 0; i < 4; ++i)
      if (is_boundary(t, i) && !is_seen(t, i)) return false;
    return true;
  }

  /// The facet strictly from inside; those through infinity need no test.
  bool is_seen(TetId t, int i) const {
    const int infinite = kernel::infinite_local(complex_, t);
    return (infinite >= 0 && i != infinite) || kernel::side(complex_, sites_, t, i, p_) > 0;
  }

  void collect_boundary() {
    cavity_.boundary.clear();
    for (const TetId t : cavity_.tets) {
      for (int i = 0; i < 4; ++i) {
        if (is_boundary(t, i)) cavity_.boundary.push_back({t, i});
      }
    }
  }

  /// Takes the last found tet around a vertex or kept segment that would vanish out of the cavity; false if none would.
  bool remove_swallower() {
    number_boundary();
    for (auto t = cavity_.tets.rbegin(); t != cavity_.tets.rend(); ++t) {
      int ends = 0;
      for (const VertexId v : complex_.vertices(*t)) {
        if (v == kInfinite) continue;
        if (!scratch_.numbers.contains(v.value())) return take_out(v, v);
        ends += static_cast<int>(mesh_.is_end_of_kept(v));
      }
      if (ends < 2) continue;
      for (const auto& [i, j] : kEdge) {
        const VertexId a = complex_.vertex(*t, i);
        const VertexId b = complex_.vertex(*t, j);
        if (mesh_.is_kept(a, b) && !on_boundary_facet(a, b)) return take_out(a, b);
      }
    }
    return false;
  }

  void number_boundary() {
    scratch_.numbers.start();
    cavity_.numbers.clear();
    for (const TetFacet& f : cavity_.boundary) {
      const std::array<VertexId, 3> v = complex_.facet_vertices(f);
      kernel::WallNumbers& numbers = cavity_.numbers.emplace_back();
      for (std::size_t j = 0; j < 3; ++j) numbers[j] = scratch_.numbers.number_of(v[j].value());
    }
    cavity_.numbered = scratch_.numbers.count();
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
  kernel::SmallMarks& marks_;
  const VertexId vertex_;
  const Vec3 p_;  ///< where the vertex is
  Cavity& cavity_;
  CavityScratch& scratch_;
  std::vector<TetId>& queue_;
};

Cavity Tetrahedralization::find_cavity(VertexId vertex, TetId hint) const {
  Cavity cavity;
  const Vec3 p = position(vertex);
  const TetId first = locate(p, hint);
  CavitySearch(*this, scratch_, vertex, p, cavity).run(first);
  return cavity;
}

void Tetrahedralization::find_cavity_at(Vec3 p, TetId holding, CavityScratch& scratch, Cavity& cavity) const {
  CavitySearch(*this, scratch, VertexId(vertices_->size()), p, cavity).run(holding);
}

}  // namespace curvetet
