// Flat faces whose parameters are sheared: facets that are valid in the chart overlap in space.
#include "support/sheared.h"

#include <gtest/gtest.h>

#include <set>

#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

Model sheared_box(double bend) {
  Model model = make_box(2, 3, 1);
  for (ModelFace& face : model.faces) shear(face, bend);
  return model;
}

std::size_t triangles(const BoundaryRun& run) {
  std::size_t count = 0;
  for (const FaceMesh& mesh : run.boundary.faces) count += mesh.triangle_count();
  return count;
}

class ShearedFaces : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(ShearedFaces, AreThinnedOutAndRecoveredWithoutPoints) {
  const auto [bend, size] = GetParam();
  const Model model = sheared_box(bend);
  BoundaryRunOptions options{size};
  options.until = Until::faces;
  const auto before = run_boundary(model, options);
  options.until = Until::classification;
  const auto run = run_boundary(model, options);
  EXPECT_GT(run->crossings.first_pairs, 0U) << "nothing to cure";
  for (const RecoveryFailure& f : run->crossings.failures) ADD_FAILURE() << f.what;
  for (const RecoveryFailure& f : run->recovery.failures) ADD_FAILURE() << f.what;
  for (const RecoveryFailure& f : run->classified.failures) ADD_FAILURE() << f.what;
  EXPECT_EQ(run->crossings.points, 0U);
  EXPECT_EQ(run->recovery.points, 0U);
  EXPECT_LT(triangles(*run), triangles(*before));
  EXPECT_EQ(check_recovered(model, *run), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Boxes, ShearedFaces,
                         testing::Values(std::tuple(0.5, 2), std::tuple(0.5, 1), std::tuple(1, 4), std::tuple(1, 1),
                                         std::tuple(1, 0.5), std::tuple(2, 0.5)));

std::size_t first_nodes(const BoundaryRun& run) {
  std::set<VertexId> nodes;
  for (const SurfaceTriangle& t : surface_triangles(run.boundary))
    for (const VertexId v : t.vertices)
      if (run.vertices.origin(v) == Origin::face_mesh) nodes.insert(v);
  return nodes.size();
}

/// A facet along a ring that is thin for the size is near its face, too, but points are what cures it.
TEST(ThinningOut, LeavesThinRingsAlone) {
  for (const auto& [minor, size] : {std::pair(0.5, 4.0), std::pair(0.5, 8.0), std::pair(0.5, 40.0)}) {
    const Model model = make_torus(33, minor);
    BoundaryRunOptions options{size, 0};
    options.gaps = false;
    options.until = Until::faces;
    const auto before = run_boundary(model, options);
    options.until = Until::crossings;
    const auto run = run_boundary(model, options);
    EXPECT_GT(run->crossings.first_folds, 0U) << "nothing to cure";
    EXPECT_TRUE(run->crossings.failures.empty()) << size;
    EXPECT_EQ(first_nodes(*run), first_nodes(*before)) << size;
  }
}

/// Where four points on a circle are triangulated in two ways, on a flat face that has nothing beyond it.
TEST(Surrounding, LetsFlatFacesOfTheHullBeRecoveredByFlips) {
  const Model model = sheared_box(0.5);
  const auto run = run_boundary(model, {1});
  EXPECT_EQ(run->recovery.points + run->recovery.volume_points, 0U);
  EXPECT_EQ(run->recovery.rounds, 0);
}

}  // namespace
}  // namespace curvetet::test
