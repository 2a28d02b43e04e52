#include "volume/refine.h"

#include <gtest/gtest.h>

#include "quality/measures.h"
#include "spatial/flips_support.h"
#include "volume/convex_bodies.h"

namespace curvetet::test {
namespace {

SizeField uniform_field(double h) {
  SizingOptions sizing;
  sizing.size = h;
  return SizeField({}, sizing);
}

/// A field that is `small` at the origin and grows from there.
SizeField graded_field(double h, double small) {
  SizingOptions sizing;
  sizing.size = h;
  SizeSource source;
  source.where = {0, 0, 0};
  source.size = small;
  return SizeField({source}, sizing);
}

double mean_interior_edge(const Body& body) {
  double sum = 0;
  std::size_t count = 0;
  const TetComplex& complex = body.mesh->complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    for (const auto& [i, j] : kEdge) {
      const VertexId u = complex.vertex(t, i), v = complex.vertex(t, j);
      if (body.store.owner(u).kind != OwnerKind::interior && body.store.owner(v).kind != OwnerKind::interior) continue;
      sum += distance(body.store.position(u), body.store.position(v));
      ++count;
    }
  }
  return sum / static_cast<double>(count);
}

/// Refines and checks what must hold after every refinement.
RefineResult refine_and_check(Body& body, const SizeField& field, const RefineOptions& options = {}) {
  const auto locked = locked_facets(body.mesh->complex());
  const double volume = sixfold_volume(*body.mesh);
  const std::size_t before = body.store.size();
  Context context;
  auto result = refine_interior(*body.mesh, body.store, field, options, context);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(defects(*body.mesh), "");
  EXPECT_EQ(locked_facets(body.mesh->complex()), locked);
  EXPECT_NEAR(sixfold_volume(*body.mesh), volume, 1e-12);
  EXPECT_EQ(body.store.size(), before + result.value().inserted);
  for (std::size_t v = before; v < body.store.size(); ++v) {
    EXPECT_EQ(body.store.owner(VertexId(v)), Owner::of(SolidId(0)));
    EXPECT_EQ(body.store.origin(VertexId(v)), Origin::interior);
    EXPECT_EQ(snap(body.store.position(VertexId(v))), body.store.position(VertexId(v)));
  }
  return result.value();
}

TEST(Refine, MeetsTheSizeOnABall) {
  const auto body = ball_body(0.4, 0.1);
  refine_and_check(*body, uniform_field(0.1));
  EXPECT_GT(mean_interior_edge(*body), 0.09);
  EXPECT_LT(mean_interior_edge(*body), 0.11);
}

TEST(Refine, VerticesKeepTheirDistance) {
  const auto body = box_body({0.4, 0.3, 0.2}, 0.1);
  refine_and_check(*body, uniform_field(0.1));
  for (std::size_t i = 0; i < body->store.size(); ++i) {
    if (!body->mesh->contains(VertexId(i))) continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (!body->mesh->contains(VertexId(j))) continue;
      EXPECT_GT(distance(body->store.position(VertexId(i)), body->store.position(VertexId(j))), 0.0599);
    }
  }
}

TEST(Refine, FollowsAGradedField) {
  const auto body = ball_body(0.4, 0.2);
  const SizeField field = graded_field(0.2, 0.02);
  const RefineResult result = refine_and_check(*body, field);
  EXPECT_GT(result.inserted, 100U);
  const TetComplex& complex = body->mesh->complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    const auto v = complex.vertices(t);
    Vec3 middle;
    bool inner = true;
    for (VertexId w : v) {
      middle = middle + 0.25 * body->store.position(w);
      inner = inner && body->store.owner(w).kind == OwnerKind::interior;
    }
    if (!inner) continue;
    const double radius = distance(circumcentre(body->store.position(v[0]), body->store.position(v[1]),
                                                body->store.position(v[2]), body->store.position(v[3])),
                                   body->store.position(v[0]));
    EXPECT_LT(radius, 1.6 * field.at(middle));
  }
}

TEST(Refine, LeavesCoarseAndThinBodiesAlone) {
  const auto cube = box_body({0.1, 0.1, 0.1}, 0.2);
  EXPECT_EQ(refine_and_check(*cube, uniform_field(0.2)).inserted, 0U);
  const auto slab = box_body({0.4, 0.4, 0.01}, 0.1);
  EXPECT_EQ(refine_and_check(*slab, uniform_field(0.1)).inserted, 0U);
}

TEST(Refine, LeavesOutsideAlone) {
  const auto body = ball_body(0.4, 0.1);
  TetComplex& complex = body->mesh->complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    if (complex.is_alive(TetId(k))) complex.set_region(TetId(k), 0);
  }
  EXPECT_EQ(refine_and_check(*body, uniform_field(0.1)).inserted, 0U);
}

TEST(Refine, StopsAtItsBudgetAndWhenAsked) {
  const auto body = ball_body(0.4, 0.1);
  RefineOptions options;
  options.max_points = 7;
  const RefineResult result = refine_and_check(*body, uniform_field(0.1), options);
  EXPECT_EQ(result.inserted, 7U);
  EXPECT_TRUE(result.budget_exhausted);
  Context context;
  context.cancel();
  EXPECT_FALSE(refine_interior(*body->mesh, body->store, uniform_field(0.1), {}, context).ok());
  EXPECT_EQ(defects(*body->mesh), "");
}

TEST(Refine, SameForAnyNumberOfThreads) {
  std::vector<std::unique_ptr<Body>> bodies;
  for (const int threads : {1, 1, 2, 5}) {
    bodies.push_back(ball_body(0.4, 0.05));
    Body& body = *bodies.back();
    Context context;
    context.threads = threads;
    ASSERT_TRUE(refine_interior(*body.mesh, body.store, graded_field(0.05, 0.02), {}, context).ok());
    EXPECT_EQ(defects(*body.mesh), "");
    EXPECT_TRUE(are_same(body, *bodies.front())) << threads;
  }
  EXPECT_GT(bodies.front()->store.size(), 3000U);
}

}  // namespace
}  // namespace curvetet::test
