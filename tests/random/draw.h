// Choices at random, the same on every machine: the library's distributions are not.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <gp_Ax2.hxx>
#include <random>

namespace curvetet::test {

/// The choices of one body. Half of all bodies are drawn on a coarse raster, so that faces, axes and radii coincide.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : generator_(seed), snapped_(coin()) {}

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_()) / 4294967296.0);
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(between(0, static_cast<double>(count))); }
  bool coin() { return below(2) == 0; }

  /// A length; on the raster a multiple of a quarter.
  double length(double low, double high) {
    const double any = between(low, high);
    return snapped_ ? std::max(0.25, std::round(4 * any) / 4) : any;
  }

  /// A place in the cube of side two around the origin, and directions there; on the raster, along the axes.
  gp_Ax2 axes() {
    const gp_XYZ at = triple(), along = triple() + gp_XYZ(0, 0, 1e-3);
    if (!snapped_) return {gp_Pnt(at), gp_Dir(along)};
    const gp_Pnt rounded(std::round(2 * at.X()) / 2, std::round(2 * at.Y()) / 2, std::round(2 * at.Z()) / 2);
    const std::size_t axis = below(3);
    return {rounded, axis == 0 ? gp_Dir(1, 0, 0) : axis == 1 ? gp_Dir(0, 1, 0) : gp_Dir(0, 0, 1)};
  }

 private:
  gp_XYZ triple() {
    const double x = between(-1, 1), y = between(-1, 1);
    return {x, y, between(-1, 1)};
  }

  std::mt19937 generator_;
  bool snapped_ = false;
};

}  // namespace curvetet::test
