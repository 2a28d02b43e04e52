// A curve that bends within the tolerance of its edge, as those of real CAD do.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include "geometry/surface.h"

namespace curvetet::test {

/// A line that wriggles about its axis.
class Wriggle final : public Curve {
 public:
  Wriggle(double height, double length) : height_(height), turn_(2 * std::numbers::pi / length) {}
  CurveKind kind() const override { return CurveKind::other; }
  Vec3 value(double t) const override { return {t, height_ * std::sin(turn_ * t), 0}; }
  CurveSecond second(double t) const override {
    const double s = std::sin(turn_ * t), c = std::cos(turn_ * t);
    return {value(t), {1, height_ * turn_ * c, 0}, {0, -height_ * turn_ * turn_ * s, 0}};
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<Wriggle>(*this); }

 private:
  double height_, turn_;
};

}  // namespace curvetet::test
