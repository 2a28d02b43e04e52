// A flat face with a lip across it: a rise much narrower than the face, within one smooth surface.
#pragma once

#include <cmath>
#include <memory>

#include "geometry/surface.h"

namespace curvetet::test {

/// Rises by 2 `height` around u = 0, within a few `width`.
class Lip final : public Surface {
 public:
  Lip(double height, double width) : height_(height), width_(width) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return {uv.x, uv.y, height_ * std::tanh(uv.x / width_)}; }
  SurfaceFirst first(Vec2 uv) const override { return {value(uv), {1, 0, slope(uv.x)}, {0, 1, 0}}; }
  SurfaceSecond second(Vec2 uv) const override {
    const SurfaceFirst at = first(uv);
    return {at.value, at.du, at.dv, {0, 0, -2 / width_ * std::tanh(uv.x / width_) * slope(uv.x)}, {}, {}};
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Lip>(*this); }

 private:
  double slope(double u) const {
    const double t = std::tanh(u / width_);
    return height_ / width_ * (1 - t * t);
  }

  double height_, width_;
};

}  // namespace curvetet::test
