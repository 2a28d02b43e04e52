// Bistellar flips and edge removal on a Tetrahedralization, exact, never touching locks, kept segments or ghosts (so
// hull facets and hull edges always stay). New tets are in the region of those they replace; across regions nothing is
// flipped.
#pragma once

#include <functional>
#include <optional>

#include "spatial/flips_exchange.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

/// 2-3: replaces an unlocked facet by the edge between the two apexes. Refused (false, nothing changed) unless all
/// three new tets are exactly positive. Both tets must be finite.
bool flip23(Tetrahedralization& mesh, TetFacet facet);

/// 3-2: replaces an unkept edge with exactly three finite tets, whose inner facets are unlocked, by a facet.
bool flip32(Tetrahedralization& mesh, TetEdge edge);

/// Edge removal: replaces the n tets around an unkept interior edge (3 <= n <= limit, inner facets unlocked, none a
/// ghost) by 2n - 4 tets over a triangulation of the ring polygon that maximises the least value of `quality` over new
/// tets (dynamic programming, Klincsek). Commits only if every new tet is exactly positive and the least quality is
/// above `at_least`. `quality` sees the four positions of a positive tet. Returns the least new quality, or nothing if
/// refused.
using TetQuality = std::function<double(Vec3, Vec3, Vec3, Vec3)>;
std::optional<double> remove_edge(Tetrahedralization& mesh, TetEdge edge, const TetQuality& quality, double at_least,
                                  int limit = 9);

/// Multi-face removal (the inverse): replaces facets between two apexes by the edge of the apexes, where that is
/// better.
std::optional<double> remove_faces(Tetrahedralization& mesh, TetFacet facet, const TetQuality& quality,
                                   double at_least);

/// What these would do, for several threads at a time while nothing changes; flips::commit does it.
struct Removal {
  flips::Exchange exchange;
  double quality = 0;  ///< least of the new tets
};
std::optional<Removal> find_edge_removal(const Tetrahedralization& mesh, TetEdge edge, const TetQuality& quality,
                                         double at_least, int limit = 9);
std::optional<Removal> find_faces_removal(const Tetrahedralization& mesh, TetFacet facet, const TetQuality& quality,
                                          double at_least);

/// Recovers the edge ab by flips without points: removes the facets and edges in its way, recursively to `depth`. True
/// if ab is then an edge; else the same tets are there as before (in other slots). Fails at once if a vertex lies on
/// ab. Ends: the count of what ab crosses falls with every step that is kept.
bool recover_edge_by_flips(Tetrahedralization& mesh, VertexId a, VertexId b, int depth = 3);

/// Recovers the facet abc, whose edges exist, by removing the edges that pierce it. True if abc is then a facet; else
/// the same tets are there as before. The caller keeps ab, bc and ca. Fails at once if a vertex lies in abc.
bool recover_facet_by_flips(Tetrahedralization& mesh, VertexId a, VertexId b, VertexId c, int depth = 3);

}  // namespace curvetet
