#include "volume/improve.h"

#include <gtest/gtest.h>

#include "quality/measures.h"
#include "spatial/flips_support.h"
#include "volume/convex_bodies.h"
#include "volume/refine.h"
#include "volume/shape.h"

namespace curvetet::test {
namespace {

struct Angles {
  double worst = 180;
  std::size_t tets = 0, below_half = 0, below_five = 0;
};

Angles angles_of(const Body& body) {
  Angles result;
  const TetComplex& complex = body.mesh->complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t) || complex.region(t) == 0) continue;
    const auto v = complex.vertices(t);
    const double angle = smallest_dihedral(body.store.position(v[0]), body.store.position(v[1]),
                                           body.store.position(v[2]), body.store.position(v[3]));
    result.worst = std::min(result.worst, angle);
    ++result.tets;
    result.below_half += angle < 0.5;
    result.below_five += angle < 5;
  }
  return result;
}

std::unique_ptr<Body> refined(std::unique_ptr<Body> body, double h) {
  SizingOptions sizing;
  sizing.size = h;
  Context context;
  EXPECT_TRUE(refine_interior(*body->mesh, body->store, SizeField({}, sizing), {}, context).ok());
  return body;
}

std::vector<Vec3> boundary_positions(const VertexStore& store) {
  std::vector<Vec3> result;
  for (std::size_t v = 0; v < store.size(); ++v) {
    if (store.owner(VertexId(v)).kind != OwnerKind::interior) result.push_back(store.position(VertexId(v)));
  }
  return result;
}

/// Improves without exchange of locks and checks what must hold after every improvement.
ImproveResult improve_and_check(Body& body, const ImproveOptions& options = {}) {
  const auto locked = locked_facets(body.mesh->complex());
  const auto boundary = boundary_positions(body.store);
  const double volume = sixfold_volume(*body.mesh);
  Context context;
  auto result = improve(*body.mesh, body.store, options, context);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(defects(*body.mesh), "");
  EXPECT_EQ(locked_facets(body.mesh->complex()), locked);
  EXPECT_EQ(boundary_positions(body.store), boundary);
  EXPECT_NEAR(sixfold_volume(*body.mesh), volume, 1e-12);
  EXPECT_GE(result.value().worst_after, result.value().worst_before);
  return result.value();
}

TEST(Improve, BallBoxAndCoarseBall) {
  for (const auto& body : {refined(ball_body(0.4, 0.1), 0.1), refined(box_body({0.4, 0.3, 0.2}, 0.1), 0.1),
                           refined(ball_body(0.4, 0.3), 0.3)}) {
    improve_and_check(*body);
    const Angles angles = angles_of(*body);
    EXPECT_EQ(angles.below_half, 0U);
    EXPECT_LE(static_cast<double>(angles.below_five), 0.005 * static_cast<double>(angles.tets));
    EXPECT_GT(angles.worst, 10);
  }
}

TEST(Improve, WithoutInteriorVertices) {
  const auto body = box_body({0.4, 0.4, 0.02}, 0.1);
  const Angles before = angles_of(*body);
  improve_and_check(*body);
  EXPECT_GE(angles_of(*body).worst, before.worst - 1e-9);
}

TEST(Improve, FlatTetsOnTheFacesOfATurnedCylinder) {
  const auto body = refined(cylinder_body(0.25, 0.6, 0.1), 0.1);
  EXPECT_GT(angles_of(*body).below_half, 0U);
  improve_and_check(*body);
  const Angles angles = angles_of(*body);
  EXPECT_EQ(angles.below_half, 0U);
  EXPECT_GT(angles.worst, 10);
}

TEST(Improve, ExchangesLocksOfFlatTetsWhereAllowed) {
  const auto body = torus_body(0.3, 0.1, 0.05);
  const std::size_t locked = body->mesh->complex().locked_count();
  ImproveOptions options;
  std::size_t asked = 0;
  options.facet_allowed = [&asked](VertexId, VertexId, VertexId, FaceId face) {
    EXPECT_EQ(face, FaceId(0));
    ++asked;
    return true;
  };
  Context context;
  const auto result = improve(*body->mesh, body->store, options, context);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(defects(*body->mesh), "");
  EXPECT_GT(asked, 0U);
  EXPECT_GT(result.value().relocks, 0U);
  EXPECT_EQ(body->mesh->complex().locked_count(), locked);
}

/// A box with a flat edge: a strip that is a hundredth of the lattice wide.
std::unique_ptr<Body> chamfered_box(double h) {
  std::vector<Vec3> points;
  const int n = static_cast<int>(std::lround(0.8 / h));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        if (i > 0 && i < n && j > 0 && j < n && k > 0 && k < n) continue;
        const Vec3 p{0.8 * i / n - 0.4, 0.8 * j / n - 0.4, 0.8 * k / n - 0.4};
        if (i < n || k < n) {
          points.push_back(p);
          continue;
        }
        points.push_back(p - Vec3{0.01 * h, 0, 0});
        points.push_back(p - Vec3{0, 0, 0.01 * h});
      }
  return convex_body(points, [](Vec3, Vec3, Vec3) { return FaceId(0); });
}

double shortest_edge(const std::array<Vec3, 4>& p) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) shortest = std::min(shortest, distance(p[i], p[j]));
  return shortest;
}

// The tets over the strip are bad whatever is done; the others need not be.
TEST(Improve, OnlyTetsOverNeedlesStayBadBesideAStrip) {
  const double h = 0.15;
  const auto body = refined(chamfered_box(h), h);
  improve_and_check(*body);
  const TetComplex& complex = body->mesh->complex();
  std::size_t over_needles = 0, others = 0;
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t) || complex.region(t) == 0) continue;
    std::array<Vec3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = body->store.position(complex.vertices(t)[i]);
    if (smallest_dihedral(p[0], p[1], p[2], p[3]) < 5) ++(shortest_edge(p) < 0.5 * h ? over_needles : others);
  }
  EXPECT_GT(over_needles, 0U);
  EXPECT_EQ(others, 0U);
}

TEST(Improve, SameForAnyNumberOfThreads) {
  std::vector<std::unique_ptr<Body>> bodies;
  for (const int threads : {1, 1, 2, 5}) {
    bodies.push_back(refined(torus_body(0.4, 0.15, 0.04), 0.03));
    Body& body = *bodies.back();
    Context context;
    context.threads = threads;
    const auto result = improve(*body.mesh, body.store, {}, context);
    ASSERT_TRUE(result.ok());
    EXPECT_GT(result.value().edge_removals, 200U);
    EXPECT_GT(result.value().moves, 20U);
    EXPECT_TRUE(are_same(body, *bodies.front())) << threads;
  }
}

TEST(Improve, StopsWhenAsked) {
  const auto body = refined(ball_body(0.4, 0.1), 0.1);
  Context context;
  context.cancel();
  EXPECT_FALSE(improve(*body->mesh, body->store, {}, context).ok());
  EXPECT_EQ(defects(*body->mesh), "");
}

TEST(Shape, LeastSineIsThatOfTheDihedralAngles) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 1000; ++k) {
    std::array<Vec3, 4> p;
    for (Vec3& x : p) x = {unit(random), unit(random), unit(random)};
    if (tet_volume(p[0], p[1], p[2], p[3]) < 0) std::swap(p[0], p[1]);
    double least = 1;
    for (double angle : dihedral_angles(p[0], p[1], p[2], p[3])) {
      least = std::min(least, std::sin(angle * std::numbers::pi / 180));
    }
    EXPECT_NEAR(least_sine(p[0], p[1], p[2], p[3]), least, 1e-9);
    EXPECT_LE(least_sine(p[1], p[0], p[2], p[3]), 0);
  }
}

TEST(Shape, OptimiserNeverMakesAStarWorse) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(-0.1, 0.1);
  StarOptimiser optimiser;
  for (int k = 0; k < 100; ++k) {
    // The facets of an octahedron with its corners shaken.
    std::array<Vec3, 6> v{Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (Vec3& x : v) x = 0.3 * (x + Vec3{unit(random), unit(random), unit(random)});
    StarFacets facets;
    for (std::size_t x : {0, 1}) {
      for (std::size_t y : {2, 3}) {
        for (std::size_t z : {4, 5}) {
          std::array<Vec3, 3> f{v[x], v[y], v[z]};
          if (tet_volume(f[0], f[1], f[2], {}) < 0) std::swap(f[0], f[1]);
          facets.push_back(f);
        }
      }
    }
    const Vec3 p = snap(Vec3{unit(random), unit(random), unit(random)});
    const double before = worst_in_star(facets, p);
    const Vec3 q = optimiser.optimise(facets, p);
    EXPECT_GE(worst_in_star(facets, q), before);
    EXPECT_GT(worst_in_star(facets, q), 0.6);
    EXPECT_EQ(snap(q), q);
  }
}

}  // namespace
}  // namespace curvetet::test
