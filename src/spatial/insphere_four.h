// insphere of four tets at once. Internal to spatial.
#pragma once

#include <array>
#include <cstdint>

#include "base/ids.h"
#include "base/vec.h"

namespace curvetet::kernel {

/// A point while building, in half a cache line, like VertexStore::Site.
struct alignas(32) Site {
  Vec3 position;
  VertexId id;               ///< the caller's, by which ties are broken
  std::uint32_t number = 0;  ///< in the boundary of the present cavity
};

static_assert(sizeof(Site) == 32, "read as a vector of four doubles");

/// One bit a lane.
struct Verdicts {
  unsigned known = 0;   ///< the sign is certain
  unsigned inside = 0;  ///< where known: the point is strictly inside
  unsigned on = 0;      ///< where known: the point is on the sphere
};

/// The fifth power of a sphere's squared size below which nothing is rounded, if all coordinates are multiples of a
/// power of two (see filters::Insphere::narrow).
double exact_below(double power);

using Corners = std::array<VertexId, 4>;  ///< of a tet

/// Of the spheres of four finite tets; `sites` are records of the size of a Site that begin with a position, `exact` is
/// what exact_below says. The bound is the first of filters::Insphere, so that the verdicts do not depend on the
/// machine's vectors.
using InsphereFour = Verdicts (*)(const void* sites, const Corners& first, const Corners& second, const Corners& third,
                                  const Corners& fourth, const Vec3& p, double exact);

/// The one for the processor at hand, and the one for all.
InsphereFour insphere_four();
InsphereFour plain_insphere_four();

}  // namespace curvetet::kernel
