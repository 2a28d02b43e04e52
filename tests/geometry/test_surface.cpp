#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "geometry/analytic.h"
#include "geometry/frame.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

constexpr double kPi = std::numbers::pi;

Placement tilted() {
  Placement at;
  at.origin = {0.1, -0.05, 0.2};
  at.x = normalized({1, 2, -1});
  at.z = normalized(cross(at.x, Vec3{0, 1, 0}));
  at.y = cross(at.z, at.x);
  at.unit = 0x1p-3;
  return at;
}

struct Case {
  std::unique_ptr<Surface> surface;
  Vec2 low, high;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  Placement mirrored = tilted();
  mirrored.z = -mirrored.z;
  for (const Placement& at : {tilted(), mirrored}) {
    all.push_back({make_plane(at), {-1, -1}, {1, 2}});
    all.push_back({make_cylinder(at, 0.2), {0, -1}, {6, 1}});
    all.push_back({make_cone(at, 0.2, 0.4), {0, -1}, {6, 2}});
    all.push_back({make_sphere(at, 0.3), {0, -1.4}, {6, 1.4}});
    all.push_back({make_torus(at, 0.3, 0.1), {0, 0}, {6, 6}});
  }
  return all;
}

TEST(Surfaces, DerivativesMatchDifferences) {
  std::mt19937 random(1);
  const double h = 1e-5;
  for (const Case& c : cases()) {
    for (int i = 0; i < 20; ++i) {
      std::uniform_real_distribution<double> u(c.low.x, c.high.x), v(c.low.y, c.high.y);
      const Vec2 uv{u(random), v(random)};
      const SurfaceSecond s = c.surface->second(uv);
      const SurfaceFirst f = c.surface->first(uv);
      EXPECT_LT(distance(s.value, c.surface->value(uv)), 1e-15);
      EXPECT_LT(distance(f.du, s.du) + distance(f.dv, s.dv), 1e-15);
      const auto right = c.surface->first({uv.x + h, uv.y}), left = c.surface->first({uv.x - h, uv.y});
      const auto up = c.surface->first({uv.x, uv.y + h}), down = c.surface->first({uv.x, uv.y - h});
      EXPECT_LT(distance(s.du, (0.5 / h) * (right.value - left.value)), 1e-8);
      EXPECT_LT(distance(s.dv, (0.5 / h) * (up.value - down.value)), 1e-8);
      EXPECT_LT(distance(s.duu, (0.5 / h) * (right.du - left.du)), 1e-8);
      EXPECT_LT(distance(s.duv, (0.5 / h) * (up.du - down.du)), 1e-8);
      EXPECT_LT(distance(s.dvv, (0.5 / h) * (up.dv - down.dv)), 1e-8);
    }
  }
}

TEST(Surfaces, ProjectionFindsTheFoot) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> offset(-0.05, 0.05);
  for (const Case& c : cases()) {
    for (int i = 0; i < 50; ++i) {
      std::uniform_real_distribution<double> u(c.low.x, c.high.x), v(c.low.y, c.high.y);
      const Vec2 uv{u(random), v(random)};
      const Vec3 point = c.surface->value(uv) + offset(random) * c.surface->normal(uv);
      const Vec2 guess{uv.x + 0.1, uv.y - 0.1};
      const auto closed = c.surface->project(point, guess);
      ASSERT_TRUE(closed);
      EXPECT_LT(distance(*closed, uv), 1e-9) << name(c.surface->kind());
      const auto iterated = c.surface->Surface::project(point, guess);
      ASSERT_TRUE(iterated) << name(c.surface->kind());
      EXPECT_LT(distance(*iterated, uv), 1e-6) << name(c.surface->kind());
    }
  }
}

TEST(Surfaces, Curvatures) {
  const Placement at = tilted();
  EXPECT_EQ(make_plane(at)->curvatures({1, 1}), (Vec2{0, 0}));
  EXPECT_NEAR(make_cylinder(at, 0.25)->curvatures({1, 1}).x, 4, 1e-12);
  EXPECT_NEAR(make_cylinder(at, 0.25)->curvatures({1, 1}).y, 0, 1e-12);
  const Vec2 sphere = make_sphere(at, 0.5)->curvatures({1, 0.5});
  EXPECT_NEAR(sphere.x, 2, 1e-6);
  EXPECT_NEAR(sphere.y, 2, 1e-6);
  const Vec2 torus = make_torus(at, 0.4, 0.1)->curvatures({1, 0});
  EXPECT_NEAR(torus.x, 10, 1e-9);
  EXPECT_NEAR(torus.y, 2, 1e-9);
}

TEST(Surfaces, NormalAtPolesIsTheLimit) {
  const Placement at;
  const auto sphere = make_sphere(at, 0.5);
  for (const double u : {0.0, 1.0, 4.0}) {
    EXPECT_LT(distance(sphere->normal({u, kPi / 2}), {0, 0, 1}), 1e-4);
    EXPECT_LT(distance(sphere->normal({u, -kPi / 2}), {0, 0, -1}), 1e-4);
  }
  const auto cone = make_cone(at, 0.3, 0.5);
  const double apex = -0.3 / std::sin(0.5);
  cone->set_domain({0, apex}, {2 * kPi, 0});
  for (const double u : {0.0, 1.0, 4.0}) {
    EXPECT_LT(distance(cone->normal({u, apex}), cone->normal({u, -0.1})), 1e-6);
  }
}

// The guess at the apex has a radius that is a rounding error, of either sign.
TEST(Surfaces, ConesProjectOnTheNappeThePointIsLevelWith) {
  const auto cone = make_cone({}, 0.3, 0.5);
  const double apex = -0.3 / std::sin(0.5);
  for (const double away : {-0.5, -1e-3, 1e-3, 0.5})
    for (const double guess : {apex - 1e-12, apex, apex + 1e-12, 0.0})
      for (const double u : {0.5, 3.0}) {
        const Vec3 p = cone->value({u, apex + away});
        const auto foot = cone->project(p, {u, guess});
        ASSERT_TRUE(foot);
        EXPECT_LT(distance(cone->value(*foot), p), 1e-12) << away << " from " << guess;
        EXPECT_NEAR(foot->y, apex + away, 1e-9);
      }
}

TEST(Curves, EllipseAndProjection) {
  const auto ellipse = make_ellipse(tilted(), 0.4, 0.2);
  const double h = 1e-5;
  for (double t = 0.1; t < 6.2; t += 0.3) {
    const CurveSecond c = ellipse->second(t);
    EXPECT_LT(distance(c.dt, (0.5 / h) * (ellipse->value(t + h) - ellipse->value(t - h))), 1e-9);
    EXPECT_LT(distance(c.dtt, (0.5 / h) * (ellipse->second(t + h).dt - ellipse->second(t - h).dt)), 1e-9);
    const Vec3 inward = normalized(cross(cross(c.dt, c.dtt), c.dt));
    EXPECT_NEAR(ellipse->project(c.value + 0.01 * inward, t + 0.2, 0, 2 * kPi), t, 1e-7);
  }
  EXPECT_NEAR(ellipse->curvature(0), 0.4 / (0.2 * 0.2), 1e-9);
  EXPECT_EQ(ellipse->project(ellipse->value(0.1), 1, 0.5, 2), 0.5);
}

TEST(Frames, ScaleIsAPowerOfTwoAndRoundTrips) {
  for (const double size : {1e-6, 0.3, 1.0, 7.0, 12345.0, 1e9}) {
    Box3 box;
    box.extend({size, 0, 0});
    box.extend({2 * size, size / 3, size / 2});
    const Frame frame = Frame::of(box);
    int exponent = 0;
    EXPECT_EQ(std::frexp(frame.scale, &exponent), 0.5);
    const Vec3 low = frame.to_working(box.low), high = frame.to_working(box.high);
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(low[i], -0.375 - 1e-12);
      EXPECT_LE(high[i], 0.375 + 1e-12);
    }
    EXPECT_GE(high.x - low.x, 0.375 - 1e-12);
    EXPECT_LT(distance(frame.to_cad(high), box.high), 1e-12 * size);
  }
}

TEST(Models, NamesAndFacesAtAVertex) {
  Model box = test::make_box(1, 2, 3);
  EXPECT_EQ(box.face_name(FaceId(0)), "face_1");
  box.faces[FaceId(0)].label.name = "inlet";
  EXPECT_EQ(box.face_name(FaceId(0)), "inlet");
  EXPECT_EQ(box.edge_name(EdgeId(6)), "edge_7");
  EXPECT_EQ(box.solid_name(SolidId(0)), "solid_1");
  for (std::size_t v = 0; v < box.vertices.size(); ++v) EXPECT_EQ(box.faces_at(CadVertexId(v)).size(), 3U);
}

/// A surface whose values are those of a body ten thousand of its diagonals from the origin, moved back.
class FarSurface : public Surface {
 public:
  explicit FarSurface(std::unique_ptr<Surface> near) : near_(std::move(near)) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return noisy(near_->value(uv)); }
  SurfaceFirst first(Vec2 uv) const override {
    SurfaceFirst s = near_->first(uv);
    s.value = noisy(s.value);
    return s;
  }
  SurfaceSecond second(Vec2 uv) const override {
    SurfaceSecond s = near_->second(uv);
    s.value = noisy(s.value);
    return s;
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<FarSurface>(near_->clone()); }

 private:
  static Vec3 noisy(Vec3 p) {
    const volatile double x = p.x + 1e4, y = p.y - 7e3, z = p.z + 3e3;
    return {x - 1e4, y + 7e3, z - 3e3};
  }
  std::unique_ptr<Surface> near_;
};

TEST(Surfaces, ProjectionEndsFarFromTheOrigin) {
  std::mt19937 random(5);
  for (Case& c : cases()) {
    const FarSurface surface(c.surface->clone());
    std::uniform_real_distribution<double> u(c.low.x, c.high.x), v(c.low.y, c.high.y), off(-0.02, 0.02);
    for (int i = 0; i < 300; ++i) {
      const Vec2 uv{u(random), v(random)};
      const Vec3 point = i % 2 == 0 ? surface.value(uv) : surface.value(uv) + off(random) * c.surface->normal(uv);
      const auto foot = surface.project(point, {uv.x + 0.01, uv.y - 0.01});
      ASSERT_TRUE(foot.has_value()) << name(c.surface->kind()) << " " << i;
      // Off the surface a step sideways is lost in the noise until its square is not.
      EXPECT_LT(distance(c.surface->value(*foot), c.surface->value(uv)), i % 2 == 0 ? 1e-9 : 1e-6);
    }
  }
}

}  // namespace
}  // namespace curvetet
