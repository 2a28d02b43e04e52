// Against volumes known in closed form, for faces with poles, seams, several loops and solids on both sides.
#include <gtest/gtest.h>

#include <numbers>

#include "geometry/enclosed_volume.h"
#include "support/bodies.h"

namespace curvetet::test {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_volume(const Model& model, SolidId solid, double cad_volume) {
  const double scale = model.frame.scale;
  const EnclosedVolume found = enclosed_volume(model, solid);
  EXPECT_NEAR(found.volume, cad_volume * scale * scale * scale, 1e-6 * std::abs(found.volume));
  EXPECT_LT(found.error, 1e-2 * std::abs(found.volume));
}

TEST(EnclosedVolume, IsThatOfKnownBodies) {
  const SolidId only(0U);
  expect_volume(make_box(2, 3, 4), only, 24);
  expect_volume(make_ball(2), only, 4 * kPi / 3 * 8);
  expect_volume(make_shell(3, 2), only, 4 * kPi / 3 * (27 - 8));
  expect_volume(make_cylinder(2, 5), only, kPi * 4 * 5);
  expect_volume(make_cone(3, 0, 4), only, kPi * 9 * 4 / 3);
  expect_volume(make_torus(5, 2), only, 2 * kPi * kPi * 5 * 4);
  expect_volume(make_tube(3, 2, 4), only, kPi * (9 - 4) * 4);
  expect_volume(make_half_ellipsoid(3, 2), only, 2 * kPi / 3 * 3 * 4);
}

TEST(EnclosedVolume, CountsEachSolidByItsOwnSide) {
  const Model nested = make_nested_balls(3, 1);
  double both = 0;
  for (std::uint32_t s = 0; s < 2; ++s) both += enclosed_volume(nested, SolidId(s)).volume;
  const double scale = nested.frame.scale;
  EXPECT_NEAR(both, 4 * kPi / 3 * 27 * scale * scale * scale, 1e-6 * both);
  const Model boxes = make_boxes({1, 2, 4}, 3, 2);
  for (std::uint32_t s = 0; s < 3; ++s) expect_volume(boxes, SolidId(s), 6.0 * (1U << s));
}

}  // namespace
}  // namespace curvetet::test
