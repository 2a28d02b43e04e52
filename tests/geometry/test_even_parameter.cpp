// Curves with most of their length in a tiny part of their range, as intersections traced by kernels have.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/analytic.h"
#include "geometry/even_parameter.h"

namespace curvetet {
namespace {

/// The angle on a circle that is run through: its second half in the last `part` of the range [0, 1].
double angle(double t, double part) {
  const double first = 1 - part;
  return std::numbers::pi * (t < first ? t / first : 1 + (t - first) / part);
}

double speed(double t, double part) { return std::numbers::pi / (t < 1 - part ? 1 - part : part); }

class HastyCircle final : public Curve {
 public:
  explicit HastyCircle(double part) : part_(part) {}
  CurveKind kind() const override { return CurveKind::bspline; }
  Vec3 value(double t) const override { return {std::cos(angle(t, part_)), std::sin(angle(t, part_)), 0}; }
  CurveSecond second(double t) const override {
    const Vec3 p = value(t);
    const double w = speed(t, part_);
    return {p, {-w * p.y, w * p.x, 0}, {-w * w * p.x, -w * w * p.y, 0}};
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<HastyCircle>(*this); }

 private:
  double part_;
};

class HastyParameterCircle final : public ParameterCurve {
 public:
  explicit HastyParameterCircle(double part) : part_(part) {}
  Vec2 value(double t) const override { return {std::cos(angle(t, part_)), std::sin(angle(t, part_))}; }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<HastyParameterCircle>(*this); }

 private:
  double part_;
};

double longest_chord(const Curve& curve, int count) {
  double longest = 0;
  for (int i = 0; i < count; ++i)
    longest = std::max(longest, distance(curve.value(static_cast<double>(i) / count),
                                         curve.value(static_cast<double>(i + 1) / count)));
  return longest;
}

TEST(EvenParameter, FewPlacesShowTheWholeCurve) {
  constexpr int kPlaces = 64;
  const double even = 2 * std::numbers::pi / kPlaces;
  for (const double part : {1e-2, 1e-6, 1e-10}) {
    const HastyCircle circle(part);
    EXPECT_GT(longest_chord(circle, kPlaces), 10 * even) << "nothing to even out";
    const auto steps = steps_along(circle, 0, 1);
    ASSERT_NE(steps, nullptr) << part;
    EXPECT_LT(longest_chord(*evened(circle.clone(), steps), kPlaces), 1.5 * even) << part;
  }
}

TEST(EvenParameter, IsRisingAndKeepsTheEndsAndTheDerivatives) {
  const HastyCircle circle(1e-6);
  const auto steps = steps_along(circle, 0, 1);
  ASSERT_NE(steps, nullptr);
  const auto curve = evened(circle.clone(), steps);
  for (const double end : {0.0, 1.0}) {
    EXPECT_EQ(steps->own(end), end);
    EXPECT_EQ(curve->value(end), circle.value(end));
  }
  EXPECT_EQ(steps->own(-0.5), -0.5);
  EXPECT_EQ(steps->own(1.5), 1.5);
  double last = 0;
  int uneven = 0;  // where the speed jumps within a piece
  for (int i = 1; i < 1000; ++i) {
    const double t = i / 1000.0, own = steps->own(t);
    EXPECT_GT(own, last);
    last = own;
    EXPECT_NEAR(steps->even(own), t, 1e-7) << "the own parameter has no more digits there";
    EXPECT_NEAR(curve->curvature(t), 1, 1e-6);
    const CurveSecond at = curve->second(t);
    uneven += std::abs(norm(at.dt) - 2 * std::numbers::pi) > 0.1 ? 1 : 0;
    EXPECT_NEAR(dot(at.dt, at.value), 0, 1e-6);
  }
  EXPECT_LT(uneven, 30);
}

TEST(EvenParameter, AnEdgesCurvesStayInStep) {
  const double part = 1e-6;
  const HastyCircle circle(part);
  const auto steps = steps_along(circle, 0, 1);
  const auto curve = evened(circle.clone(), steps);
  const auto in_face = evened(std::make_unique<HastyParameterCircle>(part), steps);
  for (int i = 0; i <= 100; ++i) {
    const Vec3 p = curve->value(i / 100.0);
    const Vec2 q = in_face->clone()->value(i / 100.0);
    EXPECT_NEAR(p.x, q.x, 1e-12);
    EXPECT_NEAR(p.y, q.y, 1e-12);
  }
}

TEST(EvenParameter, MostCurvesKeepTheirOwn) {
  EXPECT_EQ(steps_along(*make_ellipse({}, 0.4, 0.04), 0, 2 * std::numbers::pi), nullptr);
  EXPECT_EQ(steps_along(*make_line({}, {1, 0, 0}, 1), 0, 1), nullptr);
  EXPECT_EQ(steps_along(HastyCircle(0.2), 0, 1), nullptr);
  EXPECT_EQ(steps_along(HastyCircle(1e-6), 0, 0), nullptr) << "no range";
}

}  // namespace
}  // namespace curvetet
