// What a face mesh promises its users: triangles of the size, near equilateral, and no two vertices closer than need
// be.
#include <gtest/gtest.h>

#include <algorithm>

#include "boundary/surface_triangles.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

/// Twice the radius of the inscribed circle over that of the circumscribed one.
double shape_of(Vec3 a, Vec3 b, Vec3 c) {
  const double x = distance(b, c), y = distance(c, a), z = distance(a, b);
  const double four_areas = 2 * norm(cross(b - a, c - a));
  return 2 * four_areas * four_areas / ((x + y + z) * x * y * z);
}

TEST(FaceRefinement, MakesTrianglesNearEquilateral) {
  for (const Model& model :
       {make_box(2, 3, 4), make_cylinder(2, 5), make_ball(3), make_torus(5, 2), make_cone(3, 1, 4)}) {
    BoundaryRunOptions options{0.2, 0};
    options.until = Until::faces;
    const auto run = run_boundary(model, options);
    ASSERT_FALSE(HasFailure());
    const double size = model.frame.length_to_working(0.2);
    double sum = 0, worst = 1, longest = 0, shortest = 1;
    const std::vector<SurfaceTriangle> triangles = surface_triangles(run->boundary);
    for (const SurfaceTriangle& t : triangles) {
      std::array<Vec3, 3> p;
      for (std::size_t i = 0; i < 3; ++i) p[i] = run->vertices.position(t.vertices[i]);
      const double shape = shape_of(p[0], p[1], p[2]);
      sum += shape;
      worst = std::min(worst, shape);
      for (std::size_t i = 0; i < 3; ++i) {
        longest = std::max(longest, distance(p[i], p[(i + 1) % 3]));
        shortest = std::min(shortest, distance(p[i], p[(i + 1) % 3]));
      }
    }
    EXPECT_GT(sum / static_cast<double>(triangles.size()), 0.97);
    EXPECT_GT(worst, 0.55);
    EXPECT_LT(longest, 1.6 * size);
    EXPECT_GT(shortest, 0.35 * size);
  }
}

}  // namespace
}  // namespace curvetet::test
