// What the fallback refuses, and that it comes when the rounds give out.
#include "boundary/facet_fallback.h"

#include <gtest/gtest.h>

#include "boundary/reconnect.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

/// Thin bodies so coarse that facets of their faces cross, not recovered yet.
BoundaryRunOptions crossing() {
  BoundaryRunOptions options{8, 0};
  options.gaps = false;
  options.as_paper = true;  // does not cure crossings
  options.until = Until::tets;
  return options;
}

void lock_present(BoundaryRun& run, FaceId face) {
  for (const SurfaceTriangle& t : surface_triangles(run.boundary.faces[face], face))
    if (const auto facet = run.tets->find_facet(t.vertices[0], t.vertices[1], t.vertices[2]))
      run.tets->lock(*facet, face);
}

/// By comparing every two triangles.
bool crosses(const BoundaryRun& run, FaceId face, FaceId other) {
  for (const SurfaceTriangle& t : missing_triangles(*run.conjoint, face))
    for (const SurfaceTriangle& u : surface_triangles(run.boundary.faces[other], other))
      if (run.tets->find_facet(u.vertices[0], u.vertices[1], u.vertices[2]) &&
          triangles_cross(run.vertices, t.vertices, u.vertices))
        return true;
  return false;
}

void expect_refused(BoundaryRun& run, FaceId face, FaceId other) {
  const std::size_t missing = missing_triangles(*run.conjoint, face).size(), vertices = run.vertices.size(),
                    locked = run.tets->complex().locked_count();
  FaceRecoveryResult result;
  result.faces.resize(2);
  EXPECT_FALSE(fall_back(*run.conjoint, face, result, Context{}));
  ASSERT_EQ(result.failures.size(), 1U);
  EXPECT_TRUE(result.failures[0].crossing);
  EXPECT_EQ(result.failures[0].faces, (std::vector<FaceId>{face, other}));
  EXPECT_GT(result.failures[0].size, 0);
  EXPECT_EQ(result.faces[face].ladder.fallback.tried, missing);
  EXPECT_EQ(result.faces[face].ladder.fallback.recovered, 0U);
  EXPECT_EQ(missing_triangles(*run.conjoint, face).size(), missing);
  EXPECT_EQ(run.vertices.size(), vertices);
  EXPECT_EQ(run.tets->complex().locked_count(), locked);
}

TEST(FacetFallback, RefusesWhatCrossesALockedFacetAndChangesNothing) {
  std::size_t tried = 0;
  const Model shell = make_shell(10, 9.8), half = make_half_ellipsoid(1, 3);
  for (const Model* model : {&shell, &half})
    for (const auto& [face, other] : {std::pair{FaceId(0U), FaceId(1U)}, {FaceId(1U), FaceId(0U)}}) {
      const auto run = run_boundary(*model, crossing());
      ASSERT_FALSE(HasFailure());
      if (!crosses(*run, face, other)) continue;
      ++tried;
      lock_present(*run, other);
      expect_refused(*run, face, other);
    }
  EXPECT_GT(tried, 0U) << "or the test says nothing";
}

TEST(FacetFallback, OfFacesThatCrossIsAFailureThatNamesBoth) {
  for (const bool as_paper : {false, true}) {
    const Model model = make_shell(10, 9.8);
    const auto run = run_boundary(model, crossing());
    ASSERT_FALSE(HasFailure());
    FaceRecoveryOptions recovery;
    recovery.floor = 1;  // no refinement
    recovery.force_fallback = [](FaceId) { return true; };
    Context context;
    FaceRecoveryResult result;
    if (as_paper) {
      auto done = recover_faces_as_paper(*run->conjoint, recovery, context);
      ASSERT_TRUE(done.ok());
      result = std::move(done.value().recovery);
    } else {
      auto done = recover_faces(*run->conjoint, recovery, context);
      ASSERT_TRUE(done.ok());
      result = std::move(done.value());
    }
    ASSERT_EQ(result.failures.size(), 1U);
    EXPECT_TRUE(result.failures[0].crossing);
    EXPECT_EQ(result.failures[0].faces.size(), 2U);
  }
}

TEST(FacetFallback, ComesOnceTheRoundsGaveOutWhereAllowed) {
  const Model model = make_half_ellipsoid(1, 6);  // flips and filling alone leave two facets of it
  BoundaryRunOptions options{5, 12};
  options.smooth = false;
  options.recovery.rounds = 0;
  const auto failed = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  ASSERT_FALSE(failed->recovery.failures.empty()) << "or the test says nothing";
  options.recovery.fallback = true;
  const auto saved = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  EXPECT_TRUE(saved->recovery.failures.empty());
  for (const std::string& broken : check_recovered(model, *saved)) ADD_FAILURE() << broken;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceCertificate &before = failed->recovery.faces[FaceId(f)], &after = saved->recovery.faces[FaceId(f)];
    const std::size_t left = before.ladder.reconnect.tried - before.ladder.reconnect.recovered;
    EXPECT_FALSE(before.fallback);
    EXPECT_EQ(after.fallback, left > 0);
    EXPECT_EQ(after.ladder.fallback.tried, left);
    EXPECT_EQ(after.ladder.fallback.recovered, left);
  }
}

}  // namespace
}  // namespace curvetet::test
