// Flat faces with sheared parameters: nothing of the body changes, but straight lines of the chart are bent in the
// face.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "geometry/model.h"

namespace curvetet::test {

/// The surface at (u + shear (v - middle)^2, v).
class Sheared final : public Surface {
 public:
  Sheared(std::shared_ptr<const Surface> plane, double shear, double middle)
      : plane_(std::move(plane)), shear_(shear), middle_(middle) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return plane_->value(straight(uv)); }
  SurfaceFirst first(Vec2 uv) const override {
    const SurfaceFirst at = plane_->first(straight(uv));
    return {at.value, at.du, at.dv + 2 * shear_ * (uv.y - middle_) * at.du};
  }
  SurfaceSecond second(Vec2 uv) const override {
    const SurfaceFirst at = first(uv);
    return {at.value, at.du, at.dv, {}, {}, 2 * shear_ * at.du};
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Sheared>(*this); }

  /// From the parameters of the plane.
  Vec2 sheared(Vec2 uv) const { return {uv.x - bend(uv.y), uv.y}; }

 private:
  Vec2 straight(Vec2 uv) const { return {uv.x + bend(uv.y), uv.y}; }
  double bend(double v) const { return shear_ * (v - middle_) * (v - middle_); }

  std::shared_ptr<const Surface> plane_;
  double shear_, middle_;
};

class ShearedCurve final : public ParameterCurve {
 public:
  ShearedCurve(std::shared_ptr<const ParameterCurve> curve, std::shared_ptr<const Sheared> surface)
      : curve_(std::move(curve)), surface_(std::move(surface)) {}
  Vec2 value(double t) const override { return surface_->sheared(curve_->value(t)); }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<ShearedCurve>(*this); }

 private:
  std::shared_ptr<const ParameterCurve> curve_;
  std::shared_ptr<const Sheared> surface_;
};

/// Shears a flat face so that its middle line reaches `bend` times the face's width beyond its sides.
inline void shear(ModelFace& face, double bend) {
  const double half = 0.5 * (face.high.y - face.low.y);
  const double reach = bend * (face.high.x - face.low.x);
  const auto surface =
      std::make_shared<const Sheared>(face.surface, reach / (half * half), 0.5 * (face.low.y + face.high.y));
  for (Loop& loop : face.loops)
    for (EdgeUse& use : loop.uses) use.curve = std::make_shared<const ShearedCurve>(use.curve, surface);
  face.surface = surface;
  face.low.x -= reach;
}

}  // namespace curvetet::test
