// Curve meshes and face meshes on analytic bodies: whatever the size, the result is a closed simplicial surface.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "boundary/boundary_check.h"
#include "boundary/boundary_mesh.h"
#include "boundary/curve_mesh.h"
#include "boundary/surface_triangles.h"
#include "sizing/size_field.h"
#include "support/bodies.h"
#include "support/wriggle.h"

namespace curvetet {
namespace {

using namespace test;

struct NamedBody {
  const char* name;
  std::function<Model()> make;
};

const std::vector<NamedBody>& bodies() {
  static const std::vector<NamedBody> all{
      {"box", [] { return make_box(3, 2, 1); }},
      {"long_box", [] { return make_box(30, 1, 0.2); }},
      {"boxes",
       [] {
         return make_boxes({1, 2, 1}, 1, 1);
       }},
      {"ball", [] { return make_ball(1); }},
      {"shell", [] { return make_shell(1, 0.3); }},
      {"cylinder", [] { return make_cylinder(1, 3); }},
      {"wire", [] { return make_cylinder(0.02, 3); }},
      {"disc", [] { return make_cylinder(2, 0.05); }},
      {"cone", [] { return make_cone(1, 0, 2); }},
      {"needle", [] { return make_cone(0.1, 0, 2); }},
      {"frustum", [] { return make_cone(1, 0.5, 2); }},
      {"torus", [] { return make_torus(2, 0.5); }},
      {"ring", [] { return make_torus(2, 0.03); }},
      {"tube", [] { return make_tube(1, 0.8, 3); }},
      {"lens", [] { return make_lens(1, 0.3); }},
      {"nested", [] { return make_nested_balls(1, 0.5); }},
  };
  return all;
}

SizeField constant_size(const Model& model, double share) {
  SizingOptions options;
  options.size = share * model.diagonal();
  options.curvature = 0;
  options.gaps = false;
  return SizeField({}, options);
}

struct Front {
  VertexStore vertices;
  BoundaryResult result;
};

Front mesh_front(const Model& model, const SizeField& sizes, int threads = 1) {
  Context context;
  context.threads = threads;
  Front front;
  Result<BoundaryResult> result = mesh_boundary(model, sizes, front.vertices, {}, context);
  EXPECT_TRUE(result.ok());
  front.result = std::move(result.value());
  return front;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 8); ++i) text += lines[i] + "\n";
  return text;
}

class FrontOnBodies : public ::testing::TestWithParam<std::tuple<std::size_t, double>> {};

TEST_P(FrontOnBodies, IsAClosedSimplicialSurface) {
  const auto [body, share] = GetParam();
  const Model model = bodies()[body].make();
  const Front front = mesh_front(model, constant_size(model, share));
  for (const FaceFailure& failure : front.result.failures) ADD_FAILURE() << failure.cause << ": " << failure.detail;
  EXPECT_EQ(joined(check_boundary(model, front.result.mesh, front.vertices)), "");
}

INSTANTIATE_TEST_SUITE_P(Bodies, FrontOnBodies,
                         ::testing::Combine(::testing::Range<std::size_t>(0, bodies().size()),
                                            ::testing::Values(1.0, 0.2, 0.1, 0.04)),
                         [](const auto& body) {
                           return std::string(bodies()[std::get<0>(body.param)].name) + "_" +
                                  std::to_string(static_cast<int>(std::lround(1 / std::get<1>(body.param))));
                         });

double face_area(const FaceMesh& mesh, const VertexStore& vertices) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.triangle(TriangleId(t)).alive()) continue;
    const auto v = mesh.vertices(TriangleId(t));
    const Vec3 a = vertices.position(v[0]);
    area += norm(cross(vertices.position(v[1]) - a, vertices.position(v[2]) - a)) / 2;
  }
  return area;
}

/// Close to the poles of a long ellipsoid straight lines of the chart are strongly curved in space: triangles over such
/// edges used to stand upright on the surface and to lie in the flat face that meets it there.
TEST(Front, LongEllipsoidIsNotFoldedAtItsPoles) {
  const Model model = make_half_ellipsoid(5, 1);
  SizingOptions options;
  options.size = model.frame.length_to_working(1);
  options.gaps = false;
  Context context;
  auto sizes = make_size_field(model, options, context);
  ASSERT_TRUE(sizes.ok());
  const Front front = mesh_front(model, sizes.value());
  const BoundaryMesh& mesh = front.result.mesh;
  EXPECT_TRUE(crossing_pairs(front.vertices, surface_triangles(mesh), Context()).empty());
  for (const SurfaceTriangle& t : surface_triangles(mesh)) {
    Vec3 centroid{};
    for (VertexId v : t.vertices) centroid = centroid + (1.0 / 3) * front.vertices.position(v);
    const Vec3 a = front.vertices.position(t.vertices[0]);
    const Vec3 normal =
        normalized(cross(front.vertices.position(t.vertices[1]) - a, front.vertices.position(t.vertices[2]) - a));
    if (t.face != FaceId(0)) continue;
    // The ellipsoid's own normal at the foot of the centroid, from its equation.
    const Vec3 p = model.frame.to_cad(centroid);
    EXPECT_GT(dot(normal, normalized(Vec3{p.x / 25, p.y, p.z})), 0.5) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(Front, AreasConverge) {
  const Model model = make_torus(2, 0.5);
  const Front front = mesh_front(model, constant_size(model, 0.02));
  double area = 0;
  for (const FaceMesh& face : front.result.mesh.faces) area += face_area(face, front.vertices);
  const double scale = model.frame.scale;
  EXPECT_NEAR(area / (scale * scale), 4 * std::numbers::pi * std::numbers::pi * 2 * 0.5, 0.01 * 39.5);
}

TEST(Front, TrianglesFollowTheSize) {
  const Model model = make_cylinder(1, 3);
  const SizeField sizes = constant_size(model, 0.05);
  const Front front = mesh_front(model, sizes);
  double sum = 0;
  std::size_t count = 0, long_edges = 0;
  for (const FaceMesh& face : front.result.mesh.faces) {
    for (std::size_t t = 0; t < face.triangle_slots(); ++t) {
      if (!face.triangle(TriangleId(t)).alive()) continue;
      const auto v = face.vertices(TriangleId(t));
      for (std::size_t i = 0; i < 3; ++i) {
        const double length = distance(front.vertices.position(v[i]), front.vertices.position(v[(i + 1) % 3]));
        sum += length;
        ++count;
        if (length > 2 * sizes.largest()) ++long_edges;
      }
    }
  }
  EXPECT_EQ(long_edges, 0U);
  EXPECT_NEAR(sum / static_cast<double>(count), sizes.largest(), 0.25 * sizes.largest());
}

TEST(Front, IdsDoNotDependOnThreads) {
  const Model model = make_tube(1, 0.8, 3);
  const SizeField sizes = constant_size(model, 0.05);
  const Front one = mesh_front(model, sizes, 1), two = mesh_front(model, sizes, 2);
  ASSERT_EQ(one.vertices.size(), two.vertices.size());
  for (std::size_t v = 0; v < one.vertices.size(); ++v) {
    ASSERT_EQ(one.vertices.position(VertexId(v)), two.vertices.position(VertexId(v)));
  }
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceMesh &a = one.result.mesh.faces[FaceId(f)], &b = two.result.mesh.faces[FaceId(f)];
    ASSERT_EQ(a.triangle_slots(), b.triangle_slots());
    for (std::size_t t = 0; t < a.triangle_slots(); ++t) {
      ASSERT_EQ(a.triangle(TriangleId(t)).node, b.triangle(TriangleId(t)).node);
    }
  }
}

TEST(CurveMesh, HalfTurnsAreNeverOneSegment) {
  const Model model = make_cylinder(1, 3);
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const ModelEdge& edge = model.edges[EdgeId(e)];
    if (edge.degenerate || edge.curve->kind() == CurveKind::line) continue;
    const std::vector<double> t = curve_parameters(edge, EdgeId(e), constant_size(model, 10));
    for (std::size_t i = 1; i < t.size(); ++i) EXPECT_LT(t[i] - t[i - 1], 0.5 * std::numbers::pi);
  }
}

TEST(CurveMesh, TurnsWithinTheToleranceAskForNoSegments) {
  ModelEdge edge;
  edge.curve = std::make_shared<test::Wriggle>(1e-3, 4e-3);
  edge.high = 0.1;
  const Model model = make_cylinder(1, 3);
  const SizeField sizes = constant_size(model, 10);
  EXPECT_GT(curve_parameters(edge, EdgeId(0), sizes).size(), 50U);
  edge.tolerance = 2e-3;
  EXPECT_LT(curve_parameters(edge, EdgeId(0), sizes).size(), 20U);
}

TEST(CurveMesh, TwinsAreCutAtTheSamePlaces) {
  Model model = test::make_boxes({2}, 3, 1);
  // Any two edges of a length will do; the second runs the other way.
  EdgeId one, two;
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const ModelEdge& edge = model.edges[EdgeId(e)];
    const double length = distance(edge.curve->value(edge.low), edge.curve->value(edge.high));
    if (std::abs(length - model.frame.length_to_working(3)) > 1e-9) continue;
    (one.valid() ? two : one) = EdgeId(e);
  }
  ASSERT_TRUE(two.valid());
  const ModelEdge& other = model.edges[one];
  ModelEdge& edge = model.edges[two];
  edge.twin = one;
  edge.twin_scale = -(edge.high - edge.low) / (other.high - other.low);
  edge.twin_shift = edge.high - edge.twin_scale * other.low;
  for (const double size : {0.4, 10.0}) {
    VertexStore vertices;
    BoundaryMesh mesh;
    Context context;
    ASSERT_TRUE(mesh_curves(model, constant_size(model, size), vertices, mesh, context));
    const std::vector<double>&t = mesh.curves[one].parameters, &own = mesh.curves[two].parameters;
    ASSERT_EQ(t.size(), own.size());
    EXPECT_GE(t.size(), 3U) << "their segments must not coincide";
    for (std::size_t i = 0; i < t.size(); ++i) {
      EXPECT_NEAR(edge.twin_shift + edge.twin_scale * t[i], own[own.size() - 1 - i], 1e-12);
    }
  }
}

TEST(Front, CancelStops) {
  const Model model = make_ball(1);
  VertexStore vertices;
  Context context;
  context.cancel();
  const auto result = mesh_boundary(model, constant_size(model, 0.1), vertices, {}, context);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace curvetet
