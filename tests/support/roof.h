// A surface with a crease rounded far below the size of the elements, as the lip of a wing.
#pragma once

#include <cmath>
#include <memory>

#include "geometry/surface.h"

namespace curvetet::test {

/// (u, v, slope * sqrt(u^2 + width^2)): a gutter along v.
class Roof final : public Surface {
 public:
  Roof(double slope, double width) : slope_(slope), width_(width) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return {uv.x, uv.y, slope_ * root(uv.x)}; }
  SurfaceFirst first(Vec2 uv) const override { return {value(uv), {1, 0, slope_ * uv.x / root(uv.x)}, {0, 1, 0}}; }
  SurfaceSecond second(Vec2 uv) const override {
    const SurfaceFirst s = first(uv);
    const double bend = slope_ * width_ * width_ / std::pow(root(uv.x), 3);
    return {s.value, s.du, s.dv, {0, 0, bend}, {}, {}};
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Roof>(*this); }

 private:
  double root(double u) const { return std::sqrt(u * u + width_ * width_); }
  double slope_, width_;
};

}  // namespace curvetet::test
