// The tets around a vertex form a polyhedron; a neighbour that sees all of its facets from the inside takes the
// vertex's place. This is the contraction of an edge, which leaves the other end where it is. Rejected: a free place
// for the merged vertex; smoothing finds it afterwards.
#include "volume/vertex_removal.h"

#include <algorithm>

#include "predicates/predicates.h"
#include "spatial/flips_exchange.h"

namespace curvetet {

namespace {

constexpr double kLonger = 1.2;  ///< longest edge afterwards over the longest before

bool has(const std::array<VertexId, 3>& facet, VertexId v) { return facet[0] == v || facet[1] == v || facet[2] == v; }

}  // namespace

bool VertexRemoval::collect_star(VertexId v) {
  mesh_.star(v, star_);
  facets_.clear();
  link_.clear();
  longest_ = 0;
  for (TetId t : star_) {
    if (complex_.is_ghost(t) || complex_.region(t) != complex_.region(star_.front())) return false;
    const int i = complex_.local(t, v);
    for (int k = 1; k < 4; ++k)
      if (complex_.is_locked({t, (i + k) % 4})) return false;
    facets_.push_back(complex_.facet_vertices({t, i}));
    for (VertexId u : facets_.back()) {
      link_.push_back(u);
      longest_ = std::max(longest_, norm2(mesh_.position(u) - mesh_.position(v)));
    }
    for (std::size_t k = 0; k < 3; ++k)
      longest_ =
          std::max(longest_, norm2(mesh_.position(facets_.back()[k]) - mesh_.position(facets_.back()[(k + 1) % 3])));
  }
  std::sort(link_.begin(), link_.end());
  link_.erase(std::unique(link_.begin(), link_.end()), link_.end());
  return true;
}

/// Least sine of the tets that join the apex to the facets without it; 0 where they are no better than asked, or too
/// long.
double VertexRemoval::worst_from(VertexId apex, double at_least) const {
  const Vec3 p = mesh_.position(apex);
  for (VertexId u : link_)
    if (norm2(mesh_.position(u) - p) > kLonger * kLonger * longest_) return 0;
  double worst = 1;
  for (const auto& f : facets_) {
    if (has(f, apex)) continue;
    const Vec3 a = mesh_.position(f[0]), b = mesh_.position(f[1]), c = mesh_.position(f[2]);
    worst = std::min(worst, least_sine(a, b, c, p));
    if (!(worst > at_least) || orient3d(a, b, c, p) <= 0) return 0;
  }
  return worst;
}

bool VertexRemoval::remove(VertexId v, double at_least) {
  if (!collect_star(v)) return false;
  VertexId best;
  double worst = at_least;
  for (VertexId u : link_) {
    const double from = worst_from(u, worst);
    if (from > worst) worst = from, best = u;
  }
  if (!best.valid()) return false;
  commit(v, best);
  return true;
}

void VertexRemoval::commit(VertexId v, VertexId apex) {
  std::vector<TetComplex::Vertices> tets;
  for (const auto& f : facets_)
    if (!has(f, apex)) tets.push_back({f[0], f[1], f[2], apex});
  flips::commit_many(mesh_, star_, tets);
  mesh_.forget(v);
}

}  // namespace curvetet
