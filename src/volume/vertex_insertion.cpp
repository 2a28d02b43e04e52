// The cavity starts as the bad tet, or as the ring of one of its edges, with the vertex in the middle. While it is not
// good enough, it takes in the tet behind the boundary facet that makes the worst new tet, and the vertex moves to its
// best place now and then; the best state met on the way is what counts (after Klingner and Shewchuk, "Aggressive
// tetrahedral mesh improvement", 2007). A cavity whose boundary facets all see the vertex, exactly, is star-shaped, so
// the exchange is valid; that no vertex and no kept segment is swallowed is checked besides.
#include "volume/vertex_insertion.h"

#include <algorithm>

#include "geometry/frame.h"
#include "predicates/predicates.h"

namespace curvetet {

namespace {

constexpr std::size_t kLargestCavity = 40;
constexpr std::size_t kGrowthBetweenMoves = 3;

}  // namespace

bool VertexInsertion::in_cavity(TetId t, std::size_t tets) const {
  const auto end = tets_.begin() + static_cast<std::ptrdiff_t>(tets);
  return std::find(tets_.begin(), end, t) != end;
}

void VertexInsertion::collect_boundary(std::size_t tets) {
  boundary_.clear();
  facets_.clear();
  for (std::size_t k = 0; k < tets; ++k) {
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{tets_[k], i};
      if (!complex_.is_locked(f) && in_cavity(complex_.neighbour(f.tet, i), tets)) continue;
      const auto v = complex_.facet_vertices(f);
      boundary_.push_back(f);
      facets_.push_back({vertices_.position(v[0]), vertices_.position(v[1]), vertices_.position(v[2])});
    }
  }
}

bool VertexInsertion::add_worst_neighbour(Vec3 place) {
  double worst = std::numeric_limits<double>::infinity();
  TetId next;
  for (std::size_t k = 0; k < boundary_.size(); ++k) {
    if (complex_.is_locked(boundary_[k])) continue;
    const double q = least_sine(facets_[k][0], facets_[k][1], facets_[k][2], place);
    const TetId n = complex_.neighbour(boundary_[k].tet, boundary_[k].local);
    if (q < worst && !complex_.is_ghost(n) && complex_.region(n) == complex_.region(tets_[0])) worst = q, next = n;
  }
  if (!next.valid()) return false;
  tets_.push_back(next);
  return true;
}

bool VertexInsertion::keeps_everything() const {
  const auto on_boundary = [this](VertexId u, VertexId v) {
    return std::any_of(boundary_.begin(), boundary_.end(), [&](const TetFacet& f) {
      const auto w = complex_.facet_vertices(f);
      return std::find(w.begin(), w.end(), u) != w.end() && std::find(w.begin(), w.end(), v) != w.end();
    });
  };
  for (TetId t : tets_) {
    for (const auto& [i, j] : kEdge) {
      const VertexId u = complex_.vertex(t, i), v = complex_.vertex(t, j);
      if (!on_boundary(u, u) || !on_boundary(v, v)) return false;
      if (mesh_.is_kept(u, v) && !on_boundary(u, v)) return false;
    }
  }
  return true;
}

bool VertexInsertion::commit(const Candidate& best) {
  tets_.resize(best.tets);
  collect_boundary(best.tets);
  for (const auto& f : facets_) {
    if (orient3d(f[0], f[1], f[2], best.place) <= 0) return false;
  }
  if (!keeps_everything()) return false;
  const std::uint32_t region = complex_.region(tets_[0]);
  const Owner owner = Owner::of(SolidId(region - 1));
  if (spare_.valid()) {
    vertices_.move(spare_, best.place);
    vertices_.set_owner(spare_, owner);
  } else {
    spare_ = vertices_.add(best.place, owner, {}, Origin::interior);
  }
  Cavity cavity;
  cavity.vertex = spare_;
  cavity.tets = tets_;
  cavity.boundary = boundary_;
  mesh_.commit(cavity);
  spare_ = VertexId();
  return true;
}

bool VertexInsertion::try_seed(Vec3 place, double at_least) {
  Candidate best;
  place = snap(place);
  std::size_t moved_at = 0;
  while (tets_.size() <= kLargestCavity) {
    collect_boundary(tets_.size());
    if (tets_.size() >= moved_at + kGrowthBetweenMoves || moved_at == 0) {
      place = optimiser_.optimise(facets_, place);
      moved_at = tets_.size();
    }
    const double worst = worst_in_star(facets_, place);
    if (worst > best.worst) best = {place, tets_.size(), worst};
    if (!add_worst_neighbour(place)) break;
  }
  return best.worst > at_least && commit(best);
}

bool VertexInsertion::seed_edge(TetId t, int i, int j) {
  tets_.clear();
  mesh_.ring({t, i, j}, ring_);
  const VertexId p = complex_.vertex(t, i), q = complex_.vertex(t, j);
  for (TetId r : ring_) {
    if (complex_.is_ghost(r) || complex_.region(r) != complex_.region(t)) return false;
    for (int k = 0; k < 4; ++k) {
      const VertexId v = complex_.vertex(r, k);
      if (v != p && v != q && complex_.is_locked({r, k})) return false;
    }
    tets_.push_back(r);
  }
  return tets_.size() < kLargestCavity;
}

bool VertexInsertion::mend(TetId t, double at_least) {
  Vec3 sum;
  std::array<double, 6> lengths{};
  for (VertexId v : complex_.vertices(t)) sum = sum + vertices_.position(v);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = kEdge[e];
    lengths[e] = distance(vertices_.position(complex_.vertex(t, i)), vertices_.position(complex_.vertex(t, j)));
  }
  tets_.assign(1, t);
  if (try_seed(0.25 * sum, at_least)) return true;
  std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
  for (std::size_t e : order) {
    const auto [i, j] = kEdge[e];
    if (mesh_.is_kept(complex_.vertex(t, i), complex_.vertex(t, j)) || !seed_edge(t, i, j)) continue;
    const Vec3 p = vertices_.position(complex_.vertex(t, i)), q = vertices_.position(complex_.vertex(t, j));
    if (try_seed(0.5 * (p + q), at_least)) return true;
  }
  return false;
}

}  // namespace curvetet
