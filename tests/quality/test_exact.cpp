// The validator's exact signs against rational arithmetic, over all magnitudes.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "quality/exact.h"
#include "quality/point_tree.h"

namespace curvetet {
namespace {

using Rational = boost::multiprecision::cpp_rational;

int rational_orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  std::array<std::array<Rational, 3>, 3> m;
  const std::array<Vec3, 3> ends{b, c, d};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      m[i][j] = Rational(ends[i][static_cast<int>(j)]) - Rational(a[static_cast<int>(j)]);
    }
  }
  const Rational det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
                       m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return det.sign();
}

TEST(Exact, OrientationAgreesWithRationals) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300), near(-3, 3), kind(0, 3);
  for (int i = 0; i < 4000; ++i) {
    const int which = kind(random), common = exponent(random) / 3;
    const auto number = [&] {
      if (which == 0) return std::ldexp(unit(random), exponent(random));        // wildly different magnitudes
      if (which == 1) return std::ldexp(std::round(unit(random) * 4), common);  // many coplanar
      return std::ldexp(unit(random), common);
    };
    const auto point = [&] { return Vec3{number(), number(), number()}; };
    const Vec3 a = point(), b = point(), c = point();
    Vec3 d = point();
    if (which == 3) {  // nearly coplanar
      d = a + 0.25 * (b - a) + 0.5 * (c - a);
      d.x = std::nextafter(d.x, near(random) > 0 ? 1e300 : -1e300);
    }
    EXPECT_EQ(exact::orientation(a, b, c, d), rational_orientation(a, b, c, d));
    EXPECT_EQ(exact::orientation(b, a, c, d), -exact::orientation(a, b, c, d));
    EXPECT_EQ(exact::orientation(b, c, a, d), exact::orientation(a, b, c, d));
  }
}

TEST(Exact, ExtremeNumbers) {
  const double small = std::numeric_limits<double>::denorm_min(), big = std::numeric_limits<double>::max();
  EXPECT_EQ(exact::orientation({0, 0, 0}, {small, 0, 0}, {0, small, 0}, {0, 0, small}), 1);
  EXPECT_EQ(exact::orientation({-big, -big, -big}, {big, -big, -big}, {-big, big, -big}, {-big, -big, big}), 1);
  EXPECT_EQ(exact::orientation({0, 0, 0}, {big, 0, 0}, {0, small, 0}, {0, 0, small}), 1);
  EXPECT_EQ(exact::turn({0, 0, 0}, {small, 0, 0}, {0, small, 0}, 2), 1);
  EXPECT_EQ(exact::shadow_axis({0, 0, 0}, {small, 0, 0}, {0, small, 0}), 2);
  EXPECT_EQ(exact::shadow_axis({0, 0, 0}, {1, 2, 3}, {2, 4, 6}), -1);
  EXPECT_EQ(exact::shadow_axis({0, 0, 0}, {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}), -1);
}

TEST(Exact, SegmentMeetsTriangle) {
  const Vec3 a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  const auto meets = [&](Vec3 p, Vec3 q) {
    const bool forward = exact::segment_meets_triangle(p, q, a, b, c);
    EXPECT_EQ(forward, exact::segment_meets_triangle(q, p, a, b, c));
    EXPECT_EQ(forward, exact::segment_meets_triangle(p, q, b, c, a));
    EXPECT_EQ(forward, exact::segment_meets_triangle(p, q, c, b, a));
    return forward;
  };
  EXPECT_TRUE(meets({0.5, 0.5, -1}, {0.5, 0.5, 1}));
  EXPECT_TRUE(meets({0.5, 0.5, 0}, {0.5, 0.5, 1}));  // ends on it
  EXPECT_TRUE(meets({1, 1, -1}, {1, 1, 1}));         // through a side
  EXPECT_TRUE(meets({0, 0, -1}, {0, 0, 1}));         // through a corner
  EXPECT_FALSE(meets({0.5, 0.5, 0x1p-80}, {0.5, 0.5, 1}));
  EXPECT_FALSE(meets({1, std::nextafter(1.0, 2.0), -1}, {1, std::nextafter(1.0, 2.0), 1}));
  EXPECT_TRUE(meets({0.1, 0.1, 0}, {0.2, 0.2, 0}));  // inside, in its plane
  EXPECT_TRUE(meets({-1, 0.5, 0}, {3, 0.5, 0}));     // across, in its plane
  EXPECT_TRUE(meets({-1, 0, 0}, {0, 0, 0}));         // touches a corner, in its plane
  EXPECT_TRUE(meets({1, 0, 0}, {5, 0, 0}));          // along a side
  EXPECT_FALSE(meets({3, 0, 0}, {5, 0, 0}));         // on a side's line
  EXPECT_FALSE(meets({-1, 0.5, 0}, {-0.5, 0.5, 0}));
  EXPECT_FALSE(meets({2, 1, 0}, {1, 2, 0}));
}

TEST(PointTree, AgreesWithSearchingAll) {
  std::mt19937 random(12);
  for (const std::size_t n : {0U, 1U, 8U, 9U, 17U, 700U}) {
    for (const int grid : {3, 1000}) {  // on the coarse one most points have others in their place
      std::uniform_int_distribution<int> step(0, grid);
      const auto point = [&] { return Point{step(random) * 1.0, step(random) * 1.0, step(random) * 1.0}; };
      std::vector<PointTree::Item> items;
      for (std::uint32_t i = 0; i < n; ++i) items.push_back({point(), i});
      const PointTree tree(items);
      for (int i = 0; i < 50; ++i) {
        PointTree::Box box{point(), point()};
        for (std::size_t k = 0; k < 3; ++k)
          if (box.low[k] > box.high[k]) std::swap(box.low[k], box.high[k]);
        std::vector<std::uint32_t> found, expected;
        tree.within(box, [&](const PointTree::Item& item) { found.push_back(item.id); });
        std::sort(found.begin(), found.end());
        for (const PointTree::Item& item : items) {
          bool in = true;
          for (std::size_t k = 0; k < 3; ++k) in = in && box.low[k] <= item.point[k] && item.point[k] <= box.high[k];
          if (in) expected.push_back(item.id);
        }
        EXPECT_EQ(found, expected);
      }
    }
  }
}

}  // namespace
}  // namespace curvetet
