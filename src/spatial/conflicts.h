// Which neighbours of a tet join a cavity. Internal to spatial.
#pragma once

#include <bit>

#include "spatial/insphere_four.h"
#include "spatial/kernel.h"

namespace curvetet::kernel {

/// Of the neighbours that are asked for (bit i: the one opposite vertex i), those whose perturbed spheres hold p (see
/// in_conflict). `exact` is what exact_below says of all coordinates, or 0.
template <class AnySites>
unsigned conflicts_among(const TetComplex& complex, const AnySites& sites, InsphereFour insphere_four,
                         const std::array<TetId, 4>& neighbours, unsigned asked, const Vec3& p, VertexId tie_id,
                         double exact) {
  const TetComplex::Tet* const all = complex.tets();
  unsigned finite = 0;
  for (std::size_t i = 0; i < 4; ++i) finite |= static_cast<unsigned>(!complex.is_ghost(neighbours[i])) << i;
  finite &= asked;
  unsigned conflicts = 0, left = asked;
  // One alone is cheaper by itself.
  if ((finite & (finite - 1)) != 0) {
    const auto some = static_cast<std::size_t>(std::countr_zero(finite));
    const auto corners = [&](std::size_t i) -> const TetComplex::Vertices& {
      return all[neighbours[(finite >> i & 1U) != 0 ? i : some].value()].vertices;
    };
    const Verdicts verdicts = insphere_four(sites.sites, corners(0), corners(1), corners(2), corners(3), p, exact);
    conflicts = finite & verdicts.known & verdicts.inside;
    for (unsigned on = finite & verdicts.known & verdicts.on; on != 0; on &= on - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(on));
      if (in_conflict_by_id(sites, corners(i), p, tie_id)) conflicts |= 1U << i;
    }
    left &= ~(finite & verdicts.known);
  }
  for (; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    if (in_conflict(complex, sites, neighbours[i], p, tie_id)) conflicts |= 1U << i;
  }
  return conflicts;
}

}  // namespace curvetet::kernel
