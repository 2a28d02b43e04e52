#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "boundary/point_octree.h"

namespace curvetet {
namespace {

TEST(PointOctree, FindsWhatAScanFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1), size(0, 0.6);
  std::vector<Vec3> points;
  PointOctree octree;
  const auto add = [&](Vec3 p) {
    octree.add(VertexId(points.size()), p);
    points.push_back(p);
  };
  for (int i = 0; i < 400; ++i) add({place(random), place(random), place(random)});
  for (int i = 0; i < 400; ++i) add({1e-6 * place(random), 1e-6 * place(random), 0.25});
  for (int i = 0; i < 40; ++i) add({0.5, 0.5, 0.5});  // more than a cell holds, at one place
  for (int i = 0; i < 200; ++i) {
    const Vec3 centre{place(random), place(random), place(random)};
    const double radius = size(random);
    std::vector<std::uint32_t> found, expected;
    octree.visit_ball(centre, radius, [&](VertexId v) { found.push_back(v.value()); });
    for (std::size_t k = 0; k < points.size(); ++k)
      if (distance(points[k], centre) <= radius) expected.push_back(static_cast<std::uint32_t>(k));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace curvetet
