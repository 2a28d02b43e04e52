// Which tets join a cavity. Internal to spatial.
#pragma once

#include <bit>
#include <span>

#include "spatial/insphere_four.h"
#include "spatial/kernel.h"

namespace curvetet::kernel {

/// Of the four tets those that are asked for (bit i) and whose perturbed spheres hold p (see in_conflict). `exact` is
/// what exact_below says of all coordinates, or 0.
template <class AnySites>
unsigned conflicts_among(const TetComplex& complex, const AnySites& sites, InsphereFour insphere_four,
                         std::span<const TetId, 4> tets, unsigned asked, const Vec3& p, VertexId tie_id, double exact) {
  const TetComplex::Tet* const all = complex.tets();
  unsigned finite = 0;
  for (std::size_t i = 0; i < 4; ++i) finite |= static_cast<unsigned>(!complex.is_ghost(tets[i])) << i;
  finite &= asked;
  unsigned conflicts = 0, left = asked;
  // One alone is cheaper by itself.
  if ((finite & (finite - 1)) != 0) {
    const auto some = static_cast<std::size_t>(std::countr_zero(finite));
    const auto corners = [&](std::size_t i) -> const TetComplex::Vertices& {
      return all[tets[(finite >> i & 1U) != 0 ? i : some].value()].vertices;
    };
    const Verdicts verdicts = insphere_four(sites.sites, corners(0), corners(1), corners(2), corners(3), p, exact);
    conflicts = finite & verdicts.known & verdicts.inside;
    for (unsigned on = finite & verdicts.known & verdicts.on; on != 0; on &= on - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(on));
      if (in_conflict_by_id<true>(sites, corners(i), p, tie_id)) conflicts |= 1U << i;
    }
    left &= ~(finite & verdicts.known);
  }
  for (; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left));
    if (in_conflict(complex, sites, tets[i], p, tie_id)) conflicts |= 1U << i;
  }
  return conflicts;
}

}  // namespace curvetet::kernel
