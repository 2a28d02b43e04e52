// The parts that sizes are made of: trimmed domains, the tree of patches, closest pairs, bending.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/trimmed_domain.h"
#include "sizing/closest_pair.h"
#include "sizing/curvature.h"
#include "sizing/patch_model.h"
#include "support/bodies.h"
#include "support/lip.h"
#include "support/wriggle.h"

namespace curvetet {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The face of a tube's end: a ring between two circles.
FaceId plane_face(const Model& model) {
  for (std::size_t i = 0; i < model.faces.size(); ++i)
    if (model.faces[FaceId(i)].surface->kind() == SurfaceKind::plane) return FaceId(i);
  return {};
}

TEST(TrimmedDomain, RingHasAHole) {
  const Model model = test::make_tube(10, 4, 5);
  const FaceId ring = plane_face(model);
  ASSERT_TRUE(ring.valid());
  const TrimmedDomain domain(model, ring);
  const auto& surface = *model.faces[ring].surface;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec2 uv{domain.low().x + part(random) * (domain.high().x - domain.low().x),
                  domain.low().y + part(random) * (domain.high().y - domain.low().y)};
    const Vec3 p = model.frame.to_cad(surface.value(uv));
    const double radius = std::hypot(p.x, p.y);
    if (std::abs(radius - 10) < 0.05 || std::abs(radius - 4) < 0.05) continue;
    EXPECT_EQ(domain.inside(uv), radius > 4 && radius < 10) << radius;
    const double away = std::min(std::abs(radius - 10), std::abs(radius - 4));
    const SurfaceFirst s = surface.first(uv);
    const Vec2 scale{norm(s.du), norm(s.dv)};
    const auto near = [&](double reach) {
      return domain.is_near_boundary(uv, scale, model.frame.length_to_working(reach));
    };
    if (away > 0.1) {
      EXPECT_FALSE(near(away - 0.05));
    }
    EXPECT_TRUE(near(away + 0.05));
    if (domain.inside(uv)) {
      EXPECT_TRUE(domain.meets(uv - Vec2{1e-3, 1e-3}, uv + Vec2{1e-3, 1e-3}));
    }
  }
}

TEST(TrimmedDomain, CellsInTheHoleAreOutside) {
  const Model model = test::make_tube(10, 4, 5);
  const FaceId ring = plane_face(model);
  const TrimmedDomain domain(model, ring);
  const Vec2 middle = 0.5 * (domain.low() + domain.high());
  const Vec2 step = 0.02 * (domain.high() - domain.low());
  EXPECT_FALSE(domain.meets(middle - step, middle + step));
  EXPECT_FALSE(domain.inside(middle));
}

TEST(TrimmedDomain, LiftsByWholePeriods) {
  const Model model = test::make_cylinder(1, 3);
  for (std::size_t i = 0; i < model.faces.size(); ++i) {
    if (model.faces[FaceId(i)].surface->kind() != SurfaceKind::cylinder) continue;
    const TrimmedDomain domain(model, FaceId(i));
    const double v = 0.5 * (domain.low().y + domain.high().y);
    for (const int turns : {-2, -1, 1, 2}) {
      const Vec2 lifted = domain.lifted({domain.low().x + 1 + turns * kTurn, v});
      EXPECT_NEAR(lifted.x, domain.low().x + 1, 1e-12);
      EXPECT_TRUE(domain.inside(lifted));
    }
  }
}

TEST(ClosestPair, OfTwoBallsIsOnTheLineOfCentres) {
  Placement at;
  const auto one = make_sphere(at, 0.1);
  for (const double gap : {0.1, 1e-3, 1e-6}) {
    at.origin = Vec3{0.2 + gap, 0, 0};
    const auto two = make_sphere(at, 0.1);
    const auto pair = sizing::approach(*one, *two, {{0.3, 0.2}, {std::numbers::pi + 0.2, -0.3}}, 1);
    EXPECT_NEAR(distance(one->value(pair.one), two->value(pair.two)), gap, 1e-3 * gap);
  }
}

TEST(ClosestPair, NeverGrowsTheDistance) {
  Placement at;
  const auto one = make_torus(at, 0.3, 0.1);
  at.origin = {0.1, 0.05, 0.2};
  at.x = {0, 1, 0};
  at.y = {0, 0, 1};
  at.z = {1, 0, 0};
  const auto two = make_cone(at, 0.1, 0.3);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> angle(0, kTurn);
  for (int i = 0; i < 200; ++i) {
    const sizing::ParameterPair start{{angle(random), angle(random)}, {angle(random), 0.05 * angle(random)}};
    const auto pair = sizing::approach(*one, *two, start, 1);
    EXPECT_LE(distance(one->value(pair.one), two->value(pair.two)),
              distance(one->value(start.one), two->value(start.two)));
  }
}

TEST(Bending, LargestCurvatureAndItsDirection) {
  Placement at;
  const auto torus = make_torus(at, 0.3, 0.1);
  for (const double v : {0.0, 1.0, 2.0, 3.0}) {
    const auto bent = sizing::bending(*torus, {0.7, v});
    EXPECT_NEAR(bent.largest, 10, 1e-9);
    // Around the tube: one unit of length is 1 / minor radius in v.
    EXPECT_NEAR(bent.direction.x, 0, 1e-9);
    EXPECT_NEAR(std::abs(bent.direction.y), 10, 1e-9);
    EXPECT_NEAR(norm(bent.normal), 1, 1e-12);
  }
  EXPECT_EQ(sizing::bending(*make_plane(at), {1, 2}).largest, 0);
}

TEST(Bending, ChordAndHeightOfACircle) {
  for (const double height : {1e-6, 0.01, 0.5, 0.9})
    EXPECT_NEAR(1 - std::sqrt(1 - std::pow(0.5 * sizing::chord_for_height(height, 1), 2)), height, 1e-9);
  EXPECT_EQ(sizing::chord_for_height(3, 1), 2);
  EXPECT_TRUE(std::isinf(sizing::chord_for_height(1, 0)));
}

TEST(Bending, WithinTheToleranceOfAnEdgeItMeansNothing) {
  const test::Wriggle curve(1e-4, 1e-3);
  SizingOptions options;
  options.size = 0.1;
  options.curvature = 12;
  ModelEdge edge;
  edge.high = 0.1;
  const double t = 0.02525;  // at a crest
  EXPECT_LT(sizing::curve_demand(edge, curve, t, options).size, 1e-3);
  edge.tolerance = 1e-3;
  EXPECT_GE(sizing::curve_demand(edge, curve, t, options).size, 8e-3);
  // A bend that the tolerance does not hide keeps its demand.
  edge.tolerance = 1e-9;
  EXPECT_LT(sizing::curve_demand(edge, curve, t, options).size, 1e-3);
}

TEST(Bending, ALipOfAFreeFormAsksForNothingBelowTheFloor) {
  Model model;
  const FaceId face = test::add_piece(model, std::make_shared<test::Lip>(2e-4, 4e-5), {-0.2, 0}, {0.2, 0.3});
  SizingOptions options;
  options.size = 0.1;
  options.curvature = 12;
  const auto demanded = [&] {
    const sizing::FaceBending bend(model, face, options);
    const Vec2 at{2.6e-5, 0.1};  // where it bends most
    return bend.demand(at, sizing::bending(bend.surface(), at)).size;
  };
  EXPECT_LT(demanded(), 1e-3);
  options.free_form_floor = 2e-3;
  EXPECT_EQ(demanded(), 2e-3);
  const test::Wriggle curve(1e-4, 1e-3);
  ModelEdge edge;
  edge.high = 0.1;
  EXPECT_EQ(sizing::curve_demand(edge, curve, 0.02525, options).size, 2e-3);
  // A bore is what it is, however small.
  const FaceId bore = test::add_pipe(model, {0.3, 0.3, 0}, 1e-3, 0.1);
  const sizing::FaceBending bend(model, bore, options);
  EXPECT_LT(bend.demand({0.1, 0.05}, sizing::bending(bend.surface(), {0.1, 0.05})).size, 1e-3);
}

}  // namespace
}  // namespace curvetet
