// Decisions on plain values, on surfaces whose derivatives at a few points mislead.
#include "boundary/criteria.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/analytic.h"
#include "support/lip.h"

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

const Chart kChart;  // the chart is the parameter plane

Corner corner_at(const Surface& surface, Vec2 q, std::uint32_t vertex) {
  const SurfaceFirst at = surface.first(kChart.to_uv(q));
  return make_corner({VertexId(vertex), q}, at.value, at, kChart);
}

/// In its middle the lip stands at 84 degrees.
const Lip kLip(0.01, 0.001);
const ChartSurface kOnLip{kLip, kChart};

TEST(ConfirmedBent, TheSurfaceBetweenTheEndsSaysWhetherAnEdgeIsBent) {
  const Corner far = corner_at(kLip, {-0.3, 0}, 0), on_lip = corner_at(kLip, {0, 0}, 1);
  EXPECT_TRUE(bent(far, on_lip));
  EXPECT_FALSE(confirmed_bent(far, on_lip, kOnLip));
}

TEST(ConfirmedBent, AnEdgeAroundACylinderIsBent) {
  const auto cylinder = make_cylinder(Placement(), 0.2);
  const ChartSurface on{*cylinder, kChart};
  for (const double angle : {0.5, 0.9, 1.9}) {
    const Corner a = corner_at(*cylinder, {-0.5 * angle, 0}, 0), b = corner_at(*cylinder, {0.5 * angle, 0.01}, 1);
    EXPECT_EQ(confirmed_bent(a, b, on), bent(a, b)) << angle;
    EXPECT_EQ(bent(a, b), angle > 1.4) << angle;
  }
}

TEST(FlipImproves, NoFlipOnlyBecauseACornerIsOnALip) {
  const Corner a = corner_at(kLip, {-0.3, 0}, 0), b = corner_at(kLip, {0, 0}, 1);
  const Corner c = corner_at(kLip, {-0.15, 0.5}, 2), d = corner_at(kLip, {-0.15, -0.5}, 3);
  for (const FlipOrder order : {FlipOrder::bends_first, FlipOrder::upright_first}) {
    EXPECT_FALSE(flip_improves(a, b, c, d, order, kOnLip));
    EXPECT_TRUE(flip_improves(c, d, b, a, order, kOnLip));
  }
}

// On a line of the chart, but for rounding, angles are noise; the shorter edge leads to neighbours that are joined.
TEST(FlipImproves, OfCornersInALineJoinsWhatIsNear) {
  const auto on_line = [](double y, double off, std::uint32_t vertex) {
    return corner_at(kLip, {0.2 + off, y}, vertex);
  };
  const Corner a = on_line(0, 0, 0), b = on_line(0.5, 0, 1), c = on_line(0.2, -1e-12, 2), d = on_line(0.3, 1e-12, 3);
  for (const FlipOrder order : {FlipOrder::bends_first, FlipOrder::upright_first}) {
    EXPECT_TRUE(flip_improves(a, b, c, d, order, kOnLip));
    EXPECT_FALSE(flip_improves(c, d, b, a, order, kOnLip));
  }
  // By the angles at c and d, of rounding errors' size, this one would be flipped.
  const Corner near = on_line(0.3, 0, 1), beside = on_line(0.2, -1e-13, 2), far = on_line(0.6, 1e-12, 3);
  for (const FlipOrder order : {FlipOrder::bends_first, FlipOrder::upright_first})
    EXPECT_FALSE(flip_improves(a, near, beside, far, order, kOnLip));
}

TEST(Folded, ATriangleWithACornerOnALipIsNot) {
  const Corner a = corner_at(kLip, {-0.5, 0}, 0), b = corner_at(kLip, {0, 0.2}, 1), c = corner_at(kLip, {-0.5, 0.5}, 2);
  EXPECT_FALSE(folded(a, b, c, kOnLip));
  EXPECT_GT(alignment(a, b, c, kOnLip), 0.99);
  EXPECT_LT(alignment(a, c, b, kOnLip), -0.99);
  EXPECT_TRUE(folded(a, c, b, kOnLip));
}

TEST(Folded, ATriangleThatStandsOnACylinderIs) {
  const auto cylinder = make_cylinder(Placement(), 0.2);
  const ChartSurface on{*cylinder, kChart};
  const Corner a = corner_at(*cylinder, {-0.9, 0}, 0), b = corner_at(*cylinder, {0.9, 0}, 1);
  EXPECT_TRUE(folded(a, b, corner_at(*cylinder, {0, 0.02}, 2), on));
  EXPECT_FALSE(folded(a, b, corner_at(*cylinder, {0, 0.9}, 2), on));
}

/// z = u^2, where du x dv is linear.
class Trough final : public Surface {
 public:
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 q) const override { return {q.x, q.y, q.x * q.x}; }
  SurfaceFirst first(Vec2 q) const override { return {value(q), {1, 0, 2 * q.x}, {0, 1, 0}}; }
  SurfaceSecond second(Vec2 q) const override { return {value(q), {1, 0, 2 * q.x}, {0, 1, 0}, {0, 0, 2}, {}, {}}; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Trough>(); }
};

TEST(MeanNormal, IsTheNormalOfTheFacetWhereTheNormalIsLinear) {
  const Trough trough;
  const Vec3 mean = mean_normal({trough, kChart}, {0.1, 0}, {0.7, 0.1}, {0.1, 0.5});
  EXPECT_NEAR(mean.x, -2 * 0.3, 1e-14);
  EXPECT_NEAR(mean.y, 0, 1e-14);
  EXPECT_NEAR(mean.z, 1, 1e-14);
}

}  // namespace
}  // namespace curvetet::test
