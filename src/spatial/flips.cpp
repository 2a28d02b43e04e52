// Flips, edge removal and multi-face removal. Each finds what would be exchanged, judges it exactly (every new tet
// positive, no lock inside, no kept segment lost) and only then commits; see flips_exchange for the exchange itself.
//
// Edge removal is Klincsek's dynamic programming over the ring (Klincsek 1980; Shewchuk, "Two discrete optimization
// algorithms for the topological improvement of tetrahedral meshes", 2002): with three or four tets in the ring it is
// the 3-2 and the 4-4 flip. Multi-face removal grows a sheet of facets with the same two apexes from one facet over its
// three edges; an edge is crossed where that gives the better worst tet. Ghosts never take part, so the hull never
// changes.
#include "spatial/flips.h"

#include <algorithm>
#include <limits>

#include "predicates/predicates.h"
#include "spatial/flips_exchange.h"
#include "spatial/flips_ring.h"

namespace curvetet {

namespace {

using flips::Exchange;

/// A caller's quality in the form the planner wants.
struct FunctionMeasure {
  const TetQuality& quality;
  double at_least;
  double floor() const { return at_least; }
  double tet(Vec3 a, Vec3 b, Vec3 c, Vec3 d) const { return quality(a, b, c, d); }
  int facet(VertexId, VertexId, VertexId) const { return 0; }
  int edge(VertexId, VertexId) const { return 0; }
};

/// Exact positivity is all that counts.
struct AnyPositive {
  double floor() const { return 0; }
  double tet(Vec3, Vec3, Vec3, Vec3) const { return 1; }
  int facet(VertexId, VertexId, VertexId) const { return 0; }
  int edge(VertexId, VertexId) const { return 0; }
};

/// Finds the sheet of facets between the apexes `above` and `below` that is best exchanged for their edge.
class SheetRemoval {
 public:
  SheetRemoval(const Tetrahedralization& mesh, const TetQuality& quality, double at_least)
      : mesh_(mesh), complex_(mesh.complex()), quality_(quality), at_least_(at_least) {}

  std::optional<Removal> run(TetFacet facet) {
    const TetFacet other = complex_.mirror(facet);
    if (complex_.is_ghost(facet.tet) || complex_.is_ghost(other.tet)) return std::nullopt;
    if (complex_.is_locked(facet)) return std::nullopt;
    above_ = complex_.vertex(facet.tet, facet.local);
    below_ = complex_.vertex(other.tet, other.local);
    take(facet.tet, other.tet);
    const auto [u, v, w] = complex_.facet_vertices(facet);
    const double worst = std::min(
        {cross(u, v, facet.tet, other.tet), cross(v, w, facet.tet, other.tet), cross(w, u, facet.tet, other.tet)});
    if (!(worst > at_least_) || !flips::is_free(complex_, exchange_)) return std::nullopt;
    return Removal{exchange_, worst};
  }

 private:
  void take(TetId top, TetId bottom) {
    exchange_.old_tets.push_back(top);
    exchange_.old_tets.push_back(bottom);
  }

  /// The least quality on the far side of edge uv of the sheet, whose facet there lies between `top` and `bottom`: that
  /// of the one tet over uv, or, if that is worse, of what replaces the next facet. Adds the tets of its choice to the
  /// exchange.
  double cross(VertexId u, VertexId v, TetId top, TetId bottom) {
    const double stop = quality_of(u, v);
    const std::size_t old_size = exchange_.old_tets.size(), new_size = exchange_.new_tets.size();
    const double go = next_facet(u, v, top, bottom);
    if (go > std::max(stop, at_least_)) return go;
    while (exchange_.old_tets.size() > old_size) exchange_.old_tets.take(exchange_.old_tets.size() - 1);
    while (exchange_.new_tets.size() > new_size) exchange_.new_tets.take(exchange_.new_tets.size() - 1);
    exchange_.new_tets.push_back({u, v, below_, above_});
    return stop;
  }

  double next_facet(VertexId u, VertexId v, TetId top, TetId bottom) {
    constexpr double refused = -std::numeric_limits<double>::infinity();
    if (exchange_.old_tets.size() + 4 > flips::kMaxRing) return refused;
    const auto [next_top, x] = across(top, u, v, above_);
    const auto [next_bottom, y] = across(bottom, u, v, below_);
    if (x != y || x == kInfinite || !next_top.valid() || !next_bottom.valid() || mesh_.is_kept(u, v)) return refused;
    if (complex_.local(next_top, above_) < 0 || complex_.local(next_bottom, below_) < 0) return refused;
    const TetFacet sheet{next_top, complex_.local(next_top, above_)};
    if (complex_.neighbour(next_top, sheet.local) != next_bottom || complex_.is_locked(sheet)) return refused;
    if (std::find(exchange_.old_tets.begin(), exchange_.old_tets.end(), next_top) != exchange_.old_tets.end()) {
      return refused;
    }
    take(next_top, next_bottom);
    return std::min(cross(u, x, next_top, next_bottom), cross(x, v, next_top, next_bottom));
  }

  /// The tet across the facet (u, v, apex) of t, and its vertex off that facet; invalid across a lock or a ghost.
  std::pair<TetId, VertexId> across(TetId t, VertexId u, VertexId v, VertexId apex) const {
    for (int i = 0; i < 4; ++i) {
      const VertexId w = complex_.vertex(t, i);
      if (w == u || w == v || w == apex) continue;
      const TetFacet far = complex_.mirror({t, i});
      if (complex_.is_locked({t, i}) || complex_.is_ghost(far.tet)) break;
      return {far.tet, complex_.vertex(far.tet, far.local)};
    }
    return {TetId(), kInfinite};
  }

  double quality_of(VertexId u, VertexId v) const {
    const Vec3 a = mesh_.position(u), b = mesh_.position(v), c = mesh_.position(below_), d = mesh_.position(above_);
    return orient3d(a, b, c, d) > 0 ? quality_(a, b, c, d) : -std::numeric_limits<double>::infinity();
  }

  const Tetrahedralization& mesh_;
  const TetComplex& complex_;
  const TetQuality& quality_;
  double at_least_;
  VertexId above_, below_;
  Exchange exchange_;
};

}  // namespace

bool flip23(Tetrahedralization& mesh, TetFacet facet) {
  const TetComplex& complex = mesh.complex();
  const TetFacet other = complex.mirror(facet);
  if (complex.is_ghost(facet.tet) || complex.is_ghost(other.tet) || complex.is_locked(facet)) return false;
  const VertexId d = complex.vertex(facet.tet, facet.local), e = complex.vertex(other.tet, other.local);
  const auto v = complex.facet_vertices(facet);
  Exchange exchange;
  exchange.old_tets.push_back(facet.tet);
  exchange.old_tets.push_back(other.tet);
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexId a = v[i], b = v[(i + 1) % 3];
    if (orient3d(mesh.position(a), mesh.position(b), mesh.position(e), mesh.position(d)) <= 0) return false;
    exchange.new_tets.push_back({a, b, e, d});
  }
  if (!flips::is_free(complex, exchange)) return false;
  flips::commit(mesh, exchange);
  return true;
}

bool flip32(Tetrahedralization& mesh, TetEdge edge) {
  const auto ring = flips::ring_of(mesh.complex(), edge, 3);
  if (!ring || ring->tets.size() != 3 || mesh.is_kept(ring->p, ring->q)) return false;
  const AnyPositive measure;
  const auto plan = flips::RingPlanner(mesh, *ring, measure).plan();
  if (!plan) return false;
  const Exchange exchange = flips::exchange_of(*ring, *plan);
  if (!flips::is_free(mesh.complex(), exchange)) return false;
  flips::commit(mesh, exchange);
  return true;
}

std::optional<Removal> find_edge_removal(const Tetrahedralization& mesh, TetEdge edge, const TetQuality& quality,
                                         double at_least, int limit) {
  const auto ring = flips::ring_of(mesh.complex(), edge, static_cast<std::size_t>(std::max(limit, 0)));
  if (!ring || mesh.is_kept(ring->p, ring->q)) return std::nullopt;
  Exchange exchange;
  for (TetId t : ring->tets) exchange.old_tets.push_back(t);
  if (!flips::is_free(mesh.complex(), exchange)) return std::nullopt;
  const FunctionMeasure measure{quality, at_least};
  const auto plan = flips::RingPlanner(mesh, *ring, measure).plan();
  if (!plan) return std::nullopt;
  return Removal{flips::exchange_of(*ring, *plan), plan->quality};
}

std::optional<Removal> find_faces_removal(const Tetrahedralization& mesh, TetFacet facet, const TetQuality& quality,
                                          double at_least) {
  return SheetRemoval(mesh, quality, at_least).run(facet);
}

std::optional<double> remove_edge(Tetrahedralization& mesh, TetEdge edge, const TetQuality& quality, double at_least,
                                  int limit) {
  const auto found = find_edge_removal(mesh, edge, quality, at_least, limit);
  if (!found) return std::nullopt;
  flips::commit(mesh, found->exchange);
  return found->quality;
}

std::optional<double> remove_faces(Tetrahedralization& mesh, TetFacet facet, const TetQuality& quality,
                                   double at_least) {
  const auto found = find_faces_removal(mesh, facet, quality, at_least);
  if (!found) return std::nullopt;
  flips::commit(mesh, found->exchange);
  return found->quality;
}

}  // namespace curvetet
