// Working coordinates: the body moved to the origin and scaled by a power of two into [-1/2, 1/2]^3, on a grid of
// 2^-42.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace curvetet {

/// Spacing of the grid on which every vertex of the mesh lies, in working coordinates. Differences of two vertices are
/// exact in double, which the predicates rely on.
inline constexpr double kGrid = 0x1p-42;

/// Rounds to the grid; the result is exact.
inline double snap(double x) { return std::nearbyint(x * 0x1p42) * kGrid; }
inline Vec3 snap(Vec3 p) { return {snap(p.x), snap(p.y), snap(p.z)}; }

/// Map between the CAD's coordinates and working ones: working = scale * (cad - centre), scale a power of two.
struct Frame {
  Vec3 centre{};
  double scale = 1;
  /// The frame that puts the box into [-1/2, 1/2]^3, with some room on each side.
  static Frame of(const Box3& box);
  Vec3 to_working(Vec3 cad) const { return scale * (cad - centre); }
  Vec3 to_cad(Vec3 working) const { return (1 / scale) * working + centre; }
  double length_to_working(double cad) const { return scale * cad; }
  double length_to_cad(double working) const { return working / scale; }
};

}  // namespace curvetet
