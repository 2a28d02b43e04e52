// What a face mesh promises its users: triangles of the size, near equilateral, and no two vertices closer than need
// be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "boundary/surface_triangles.h"
#include "geometry/frame.h"
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

TEST(FaceRefinement, LeavesValidMeshesWithNodesOnTheirSurface) {
  for (const bool smooth : {false, true}) {
    for (const Model& model : {make_tube(4, 3, 5), make_ball(3), make_half_ellipsoid(3, 1), make_cone(3, 0, 4)}) {
      BoundaryRunOptions options{0.6, 12};
      options.until = Until::faces;
      options.smooth = smooth;
      const auto run = run_boundary(model, options);
      ASSERT_FALSE(HasFailure());
      std::size_t inside = 0;
      for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const FaceMesh& mesh = run->boundary.faces[FaceId(f)];
        EXPECT_EQ(mesh.check(), std::vector<std::string>{});
        for (std::size_t n = 0; n < mesh.node_count(); ++n) {
          const FaceNode& node = mesh.node(NodeId(n));
          if (run->vertices.origin(node.vertex) != Origin::face_mesh) continue;
          const Vec3 on_surface = model.faces[FaceId(f)].surface->value(mesh.chart.to_uv(node.q));
          EXPECT_LE(distance(on_surface, run->vertices.position(node.vertex)), 2 * kGrid);
          EXPECT_EQ(run->vertices.parameter(node.vertex), mesh.chart.to_uv(node.q));
          ++inside;
        }
      }
      EXPECT_GT(inside, 0U);
    }
  }
}

/// Unit normal of a cone around z; zero at its apex, which is over the origin.
Vec3 outward(Vec3 p, double half_angle) {
  const double r = std::hypot(p.x, p.y);
  if (r < 1e-9) return {};
  return {std::cos(half_angle) * p.x / r, std::cos(half_angle) * p.y / r, std::sin(half_angle)};
}

// Near its tip a needle is thinner than the least size: triangles that span half a turn would cut through its middle.
// Edges are split from 130 degrees on, but not where the new point would be too close to another: 133 were seen.
TEST(FaceRefinement, GoesAroundTheTipOfANeedleInSteps) {
  for (const double half_angle : {0.01, 0.03, 0.1, 0.3}) {
    for (const double size : {0.3, 0.5, 0.9}) {
      BoundaryRunOptions options{size, 12};
      options.until = Until::faces;
      const Model model = make_cone(2 * std::tan(half_angle), 0, 2);
      const auto run = run_boundary(model, options);
      ASSERT_FALSE(HasFailure());
      const FaceId side(1);
      const double sign = model.faces[side].reversed ? -1 : 1;
      double farthest = 0, worst = 1;
      for (const SurfaceTriangle& t : surface_triangles(run->boundary.faces[side], side)) {
        std::array<Vec3, 3> p, n;
        for (std::size_t i = 0; i < 3; ++i) {
          p[i] = model.frame.to_cad(run->vertices.position(t.vertices[i]));
          n[i] = outward(p[i], half_angle);
        }
        for (std::size_t i = 0; i < 3; ++i)
          farthest = std::max(farthest, std::acos(std::clamp(dot(n[i], n[(i + 1) % 3]), -1.0, 1.0)));
        const Vec3 normal = sign * cross(p[1] - p[0], p[2] - p[0]);
        worst = std::min(worst, dot(normal, outward((1.0 / 3) * (p[0] + p[1] + p[2]), half_angle)) / norm(normal));
      }
      EXPECT_LT(farthest, 2.6) << half_angle << " " << size;
      EXPECT_GT(worst, 0.1) << half_angle << " " << size;
    }
  }
}

bool any_tip(const Model& model) {
  BoundaryRunOptions options{0.5, 12};
  options.until = Until::faces;
  const auto run = run_boundary(model, options);
  return std::any_of(run->boundary.faces.begin(), run->boundary.faces.end(),
                     [](const FaceMesh& mesh) { return mesh.has_tip(); });
}

// However sharp: the rays of a needle hardly turn, its normals do.
TEST(FaceRefinement, ATipIsAPoleThatTheFaceGoesAround) {
  EXPECT_TRUE(any_tip(make_cone(0.02, 0, 2)));
  EXPECT_TRUE(any_tip(make_cone(20, 0, 2)));
  EXPECT_TRUE(any_tip(make_ball(2)));
  EXPECT_FALSE(any_tip(make_half_ellipsoid(3, 1))) << "its poles are on the rim";
  EXPECT_FALSE(any_tip(make_cylinder(1, 2)));
}

}  // namespace
}  // namespace curvetet::test
