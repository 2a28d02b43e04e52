// Decisions on plain values.
#include "boundary/criteria.h"

#include <gtest/gtest.h>

#include <cmath>

namespace curvetet::test {
namespace {

/// A plane that runs backwards for a thousandth of its length, as the lip of a wing that doubles back.
class Pleat final : public Surface {
 public:
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return {uv.x - 3 * uv.x * bump(uv.x), uv.y, 0}; }
  SurfaceFirst first(Vec2 uv) const override {
    const double s = uv.x / kWidth;
    return {value(uv), {1 - 3 * (1 - 2 * s * s) * bump(uv.x), 0, 0}, {0, 1, 0}};
  }
  SurfaceSecond second(Vec2 uv) const override { return {value(uv), first(uv).du, first(uv).dv, {}, {}, {}}; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Pleat>(*this); }

 private:
  static constexpr double kWidth = 1e-3;
  static double bump(double u) { return std::exp(-(u / kWidth) * (u / kWidth)); }
};

TEST(Criteria, ATriangleOverACreaseIsJudgedByTheMeanNormal) {
  const Pleat pleat;
  const Chart chart;
  const std::array<Vec2, 3> q{Vec2{-0.2, 0}, Vec2{0.1, 0}, Vec2{0.1, 0.1}};  // its middle is within the pleat
  const std::array<Vec3, 3> p{pleat.value(q[0]), pleat.value(q[1]), pleat.value(q[2])};
  ASSERT_LT(dot(cross(p[1] - p[0], p[2] - p[0]), pleat.normal({0, 0.03})), 0);
  EXPECT_GT(facing(pleat, chart, q, p), 0.5);
  EXPECT_LT(facing(pleat, chart, q, {p[0], p[2], p[1]}), -0.5);
}

}  // namespace
}  // namespace curvetet::test
