#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/tet_complex.h"
#include "quality/measures.h"

namespace curvetet {
namespace {

const Vec3 kO{0, 0, 0}, kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

TEST(Measures, CornerTet) {
  EXPECT_DOUBLE_EQ(tet_volume(kO, kX, kY, kZ), 1.0 / 6);
  EXPECT_DOUBLE_EQ(tet_volume(kO, kY, kX, kZ), -1.0 / 6);
  const std::array<double, 6> angles = dihedral_angles(kO, kX, kY, kZ);
  for (int e = 0; e < 3; ++e) EXPECT_NEAR(angles[static_cast<std::size_t>(e)], 90, 1e-12);
  const double slanted = std::atan(std::sqrt(2.0)) * 180 / std::numbers::pi;
  for (int e = 3; e < 6; ++e) EXPECT_NEAR(angles[static_cast<std::size_t>(e)], slanted, 1e-12);
  EXPECT_NEAR(smallest_dihedral(kO, kX, kY, kZ), slanted, 1e-12);
  EXPECT_NEAR(distance(circumcentre(kO, kX, kY, kZ), {0.5, 0.5, 0.5}), 0, 1e-15);
  EXPECT_NEAR(radius_edge_ratio(kO, kX, kY, kZ), std::sqrt(0.75), 1e-15);
}

TEST(Measures, RegularTetIsBest) {
  const Vec3 a{1, 1, 1}, b{-1, 1, -1}, c{1, -1, -1}, d{-1, -1, 1};
  ASSERT_GT(tet_volume(a, b, c, d), 0);
  EXPECT_NEAR(radius_ratio(a, b, c, d), 1, 1e-14);
  EXPECT_NEAR(smallest_dihedral(a, b, c, d), std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
}

TEST(Measures, FlatAndInvertedAreZero) {
  const Vec3 inside{0.25, 0.25, 0};
  EXPECT_EQ(radius_ratio(kO, kX, kY, inside), 0);
  EXPECT_EQ(smallest_dihedral(kO, kX, kY, inside), 0);
  EXPECT_EQ(radius_ratio(kO, kY, kX, kZ), 0);
  EXPECT_EQ(smallest_dihedral(kO, kY, kX, kZ), 0);
  EXPECT_FALSE(finite(circumcentre(kO, kX, kY, inside)));
}

TEST(Measures, RandomTets) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  auto point = [&] { return Vec3{coordinate(random), coordinate(random), coordinate(random)}; };
  for (int i = 0; i < 1000; ++i) {
    std::array<Vec3, 4> p{point(), point(), point(), point()};
    if (tet_volume(p[0], p[1], p[2], p[3]) < 0) std::swap(p[0], p[1]);
    if (tet_volume(p[0], p[1], p[2], p[3]) < 1e-4) continue;
    const Vec3 centre = circumcentre(p[0], p[1], p[2], p[3]);
    for (const Vec3& q : p) EXPECT_NEAR(distance(centre, q) / distance(centre, p[0]), 1, 1e-8);
    const double ratio = radius_ratio(p[0], p[1], p[2], p[3]);
    EXPECT_GT(ratio, 0);
    EXPECT_LE(ratio, 1);
    EXPECT_NEAR(radius_ratio(p[1], p[2], p[0], p[3]), ratio, 1e-10);
    // The dihedral angles of a tet never sum to less than one turn or more than one and a half.
    double sum = 0;
    for (const double angle : dihedral_angles(p[0], p[1], p[2], p[3])) sum += angle;
    EXPECT_GT(sum, 360);
    EXPECT_LT(sum, 540);
    const Vec3 middle = equatorial_centre(p[0], p[1], p[2]);
    EXPECT_NEAR(distance(middle, p[0]), distance(middle, p[1]), 1e-8);
    EXPECT_NEAR(distance(middle, p[0]), distance(middle, p[2]), 1e-8);
    EXPECT_NEAR(dot(middle - p[0], cross(p[1] - p[0], p[2] - p[0])), 0, 1e-8);
  }
}

}  // namespace
}  // namespace curvetet
