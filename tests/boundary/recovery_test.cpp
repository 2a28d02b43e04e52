// The boundary stages from face meshes to classified tets, on analytic bodies at several sizes, in both modes.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <random>
#include <set>
#include <string_view>

#include "boundary/refine_surface.h"
#include "boundary/simplicial.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

struct Case {
  const char* name;
  std::function<Model()> make;
  double size;
  double curvature;
};

std::vector<Case> cases() {
  return {
      {"box_coarse", [] { return make_box(2, 3, 4); }, 5, 12},
      {"box_fine", [] { return make_box(2, 3, 4); }, 0.7, 12},
      {"boxes",
       [] {
         return make_boxes({1, 2, 1}, 1, 1);
       },
       0.6, 12},
      {"ball_coarse", [] { return make_ball(3); }, 6, 0},
      {"ball", [] { return make_ball(3); }, 1, 12},
      {"shell", [] { return make_shell(10, 9); }, 5, 0},
      {"thin_shell", [] { return make_shell(10, 9.8); }, 8, 0},
      {"cylinder_coarse", [] { return make_cylinder(1, 5); }, 10, 0},
      {"cylinder", [] { return make_cylinder(2, 5); }, 0.8, 12},
      {"cone", [] { return make_cone(2, 0, 4); }, 1, 12},
      {"frustum", [] { return make_cone(2, 1, 4); }, 1, 12},
      {"torus", [] { return make_torus(5, 1); }, 1, 12},
      {"torus_coarse", [] { return make_torus(5, 2); }, 8, 0},
      {"tube", [] { return make_tube(10, 9.5, 30); }, 5, 0},
      {"thin_tube", [] { return make_tube(10, 9.8, 30); }, 8, 0},
      {"lens", [] { return make_lens(5, 0.5); }, 6, 0},
      {"nested_balls", [] { return make_nested_balls(3, 2); }, 1, 12},
  };
}

class Recovery : public testing::TestWithParam<Case> {};

void expect_recovered(const Model& model, const BoundaryRun& run) {
  for (const RecoveryFailure& f : run.recovery.failures) ADD_FAILURE() << f.what;
  for (const RecoveryFailure& f : run.classified.failures) ADD_FAILURE() << f.what;
  if (testing::Test::HasFailure()) return;
  for (const std::string& broken : check_recovered(model, run)) ADD_FAILURE() << broken;
  const auto locked = locked_facets(*run.tets, model.faces.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    EXPECT_EQ(locked[FaceId(f)], run.recovery.faces[FaceId(f)].locked) << "face " << f;
}

void expect_no_fallback(const FaceRecoveryResult& recovery) {
  for (const FaceCertificate& c : recovery.faces) {
    EXPECT_FALSE(c.fallback);
    EXPECT_EQ(c.ladder.fallback.tried, 0U);
  }
}

TEST_P(Recovery, DefaultModeLocksEveryFaceAndTellsTheSolidsApart) {
  const Model model = GetParam().make();
  const auto run = run_boundary(model, {GetParam().size, GetParam().curvature});
  ASSERT_FALSE(HasFailure());
  EXPECT_TRUE(run->crossings.failures.empty());
  expect_recovered(model, *run);
}

class PaperRecovery : public Recovery {};

TEST_P(PaperRecovery, LocksEveryFaceAndTellsTheSolidsApart) {
  const Model model = GetParam().make();
  BoundaryRunOptions options{GetParam().size, GetParam().curvature};
  options.as_paper = true;
  const auto run = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  expect_recovered(model, *run);
  expect_no_fallback(run->recovery);
}

INSTANTIATE_TEST_SUITE_P(Bodies, Recovery, testing::ValuesIn(cases()),
                         [](const auto& tested) { return std::string(tested.param.name); });

INSTANTIATE_TEST_SUITE_P(Bodies, PaperRecovery, testing::ValuesIn(cases()),
                         [](const auto& tested) { return std::string(tested.param.name); });

PaperCounts paper_counts(const Model& model, double size) {
  BoundaryRunOptions options{size, 12};
  options.as_paper = true;
  options.smooth = false;
  return run_boundary(model, options)->paper;
}

// Nodes on both sides of the seam are in one place; before there are others, distances in space mean nothing.
TEST(Recovery, ThinRingsHaveNoCrossingsToBeginWith) {
  for (const double thickness : {0.3, 0.7}) {
    const Model ring = test::make_torus(33, thickness);
    test::BoundaryRunOptions options;
    options.size = 19;
    options.until = test::Until::crossings;
    const auto run = test::run_boundary(ring, options);
    EXPECT_EQ(run->crossings.first_pairs, 0U);
    const double rows = options.curvature, columns = rows * 33 / thickness;
    EXPECT_LT(static_cast<double>(run->boundary.faces[FaceId(0U)].triangle_count()), 4 * rows * columns);
  }
}

TEST(PaperCounts, StageOneRefinesAndItsCancelRuleAllows) {
  const PaperCounts counts = paper_counts(make_tube(10, 9.5, 30), 5);
  ASSERT_FALSE(HasFailure());
  EXPECT_GT(counts.stage_one_points, 0u);
  EXPECT_GT(counts.stage_one_allowed, 0u);
}

// Case 1: the other diagonal of a face of two triangles leaves nothing of t_ps that is a facet.
TEST(PaperCounts, RemeshingCaseOneStartsFromNothing) {
  const Model model = make_box(2, 2, 2);
  BoundaryRunOptions options{10, 12};
  options.until = Until::tets;
  options.as_paper = true;
  const auto run = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  FaceMesh& mesh = run->boundary.faces[FaceId(0)];
  ASSERT_EQ(mesh.triangle_count(), 2u);
  const FaceTriangle first = mesh.triangle(TriangleId(0));
  const auto inner = static_cast<std::size_t>(
      std::find_if(first.neighbour.begin(), first.neighbour.end(), [](TriangleId t) { return t.valid(); }) -
      first.neighbour.begin());
  const NodeId apex = first.node[inner], a = first.node[(inner + 1) % 3], b = first.node[(inner + 2) % 3];
  NodeId across;
  for (NodeId n : mesh.triangle(first.neighbour[inner]).node)
    if (n != a && n != b) across = n;
  ASSERT_TRUE(mesh.replace(std::vector<NodeTriple>{{apex, a, across}, {apex, across, b}}));
  Context context;
  const auto recovered = recover_faces_as_paper(*run->conjoint, {1e-3}, context);
  ASSERT_TRUE(recovered.ok());
  for (const RecoveryFailure& f : recovered.value().recovery.failures)
    ADD_FAILURE() << f.what << ", face " << f.faces.front().value();
  EXPECT_GT(recovered.value().counts.case1, 0u);
  expect_no_fallback(recovered.value().recovery);
}

/// Flips edges of the first face at random until t_3d is no surface over its vertices any more; false if that does not
/// come about.
bool spoil(const Model& model, BoundaryMesh& boundary) {
  std::mt19937 random(1);
  FaceMesh& mesh = boundary.faces[FaceId(0)];
  for (int step = 0; step < 2000; ++step) {
    const TriangleId t(random() % mesh.triangle_slots());
    if (mesh.triangle(t).alive() && mesh.flip({t, static_cast<int>(random() % 3)}) &&
        !find_offences(model, boundary).empty())
      return true;
  }
  return false;
}

// Case 2: an edge that t_3d uses four times, or a triangle that it has twice (Fig. 12).
TEST(PaperCounts, CaseTwoRefinesEdgesUsedTooOften) {
  for (const Model& model : {make_torus(5, 2), make_ball(3), make_tube(10, 5, 3), make_cylinder(1, 5),
                             make_half_ellipsoid(1, 3), make_cone(2, 1, 4)}) {
    BoundaryRunOptions options{30, 0};
    options.until = Until::tets;
    options.as_paper = true;
    options.smooth = false;
    const auto run = run_boundary(model, options);
    ASSERT_FALSE(HasFailure());
    if (!spoil(model, run->boundary)) continue;
    Context context;
    const auto recovered = recover_faces_as_paper(*run->conjoint, {1e-3}, context);
    ASSERT_TRUE(recovered.ok());
    EXPECT_GT(recovered.value().counts.case2, 0u);
    EXPECT_TRUE(recovered.value().recovery.failures.empty());
    EXPECT_TRUE(find_offences(model, run->boundary).empty());
    return;
  }
  FAIL() << "no flip spoils any of the bodies";
}

TEST(PaperCounts, RemeshingCasesThreeAndFourAreMet) {
  PaperCounts sum;
  // At the sharp rim of a flat body t_ps does not agree with t_3d at first.
  for (const double b : {3.0, 6.0}) {
    const PaperCounts counts = paper_counts(make_half_ellipsoid(1, b), 5);
    ASSERT_FALSE(HasFailure());
    sum.case3a += counts.case3a;
    sum.case3b += counts.case3b;
    sum.case4 += counts.case4;
  }
  EXPECT_GT(sum.case3a, 0u);
  EXPECT_GT(sum.case3b, 0u);
  EXPECT_GT(sum.case4, 0u);
}

// A facet far from its face can look along the mean normal below it, and still away from the surface it is nearest to.
TEST(Crossings, NoFacetLooksAwayFromTheSurfaceNextToIt) {
  for (const auto& [model, size] :
       {std::pair{make_half_ellipsoid(10, 1), 8.0}, {make_half_ellipsoid(1, 10), 8.0}, {make_torus(5, 4), 12.0}}) {
    BoundaryRunOptions options{size, 0};
    options.until = Until::crossings;
    const auto run = run_boundary(model, options);
    ASSERT_FALSE(HasFailure());
    EXPECT_TRUE(run->crossings.failures.empty());
    for (const SurfaceTriangle& t : surface_triangles(run->boundary))
      EXPECT_GE(facing_at_foot(*run->conjoint, t.face, run->boundary.faces[t.face].triangle(t.triangle).node), 0)
          << "face " << t.face.value();
  }
}

// The thinner the wall, the more points it takes: far more than there are triangles and crossings to begin with.
TEST(Crossings, CoarseThinShellsWithoutGapSizesAreCured) {
  for (const double wall : {0.2, 0.05, 0.02}) {
    const Model model = make_shell(10, 10 - wall);
    BoundaryRunOptions options{8, 0};
    options.gaps = false;
    options.until = Until::crossings;
    const auto run = run_boundary(model, options);
    ASSERT_FALSE(HasFailure());
    EXPECT_GT(run->crossings.first_pairs, 0u);
    EXPECT_TRUE(run->crossings.failures.empty()) << "wall " << wall;
    EXPECT_TRUE(crossing_pairs(run->vertices, surface_triangles(run->boundary), Context()).empty());
  }
}

// What is asked for some triangles alone is what a look at all of them says of these.
TEST(Crossings, OfFreshTrianglesAreThoseWithOneOfThem) {
  BoundaryRunOptions options{8, 0};
  options.gaps = false;
  options.until = Until::faces;
  const auto run = run_boundary(make_pierced_ball(5, 1, 14), options);
  ASSERT_FALSE(HasFailure());
  const std::vector<SurfaceTriangle> triangles = surface_triangles(run->boundary);
  const auto all = crossing_pairs(run->vertices, triangles, Context());
  ASSERT_FALSE(all.empty());
  for (const std::uint32_t stride : {1U, 2U, 7U, 1000000U}) {
    std::vector<char> is_fresh(triangles.size(), 0);
    for (std::size_t i = 0; i < triangles.size(); i += stride) is_fresh[i] = 1;
    std::vector<TrianglePair> expected;
    for (const TrianglePair& pair : all)
      if (is_fresh[pair.first] != 0 || is_fresh[pair.second] != 0) expected.push_back(pair);
    EXPECT_EQ(crossing_pairs(run->vertices, triangles, is_fresh, all.size(), Context()), expected) << stride;
  }
  EXPECT_EQ(crossing_pairs(run->vertices, triangles, std::vector<char>(triangles.size(), 1), 1, Context()).size(), 1U);
}

// Refinement does not separate what crosses indeed, and stops long before the floor of spacing is reached everywhere.
TEST(Crossings, OfATorusThatCrossesItselfEndInAFailure) {
  BoundaryRunOptions options{8, 0};
  options.until = Until::crossings;
  const Model model = make_torus(5, 5.5);
  const auto run = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  ASSERT_FALSE(run->crossings.failures.empty());
  EXPECT_TRUE(run->crossings.failures[0].crossing);
  EXPECT_LT(surface_triangles(run->boundary).size(), 20000U);
}

// Facets go through each other by more than they leave their faces: no size helps, and nobody waits for the floor.
TEST(Crossings, OfFacesThatPassThroughEachOtherEndEarly) {
  for (const double size : {8.0, 4.0, 1.0}) {
    BoundaryRunOptions options{size, 0};
    options.until = Until::faces;
    const Model model = make_pierced_ball(5, 1, 14);
    const auto before = run_boundary(model, options);
    options.until = Until::crossings;
    const auto run = run_boundary(model, options);
    ASSERT_FALSE(HasFailure());
    ASSERT_FALSE(run->crossings.failures.empty());
    for (const RecoveryFailure& failure : run->crossings.failures) {
      EXPECT_TRUE(failure.crossing);
      EXPECT_EQ(failure.size, 0);
      EXPECT_NE(failure.faces[0], failure.faces[1]) << "neither face crosses itself";
    }
    EXPECT_LT(surface_triangles(run->boundary).size(), 10 * surface_triangles(before->boundary).size()) << size;
  }
}

// What else crosses for now, as the two sides of a thin wall, is not told beside it.
TEST(Crossings, OfFacesThatPassThroughEachOtherAreToldAlone) {
  const Model model = make_pierced_ball(5, 1, 14, 10, 0.05);
  BoundaryRunOptions options{8, 0};
  options.gaps = false;
  options.until = Until::faces;
  const auto before = run_boundary(model, options);
  const auto triangles = surface_triangles(before->boundary);
  const auto pairs = crossing_pairs(before->vertices, triangles, Context());
  const auto crosses = [&](FaceId face) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return triangles[pair.first].face == face || triangles[pair.second].face == face;
    });
  };
  EXPECT_TRUE(crosses(FaceId(4))) << "nothing else crosses";
  options.until = Until::crossings;
  const auto run = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  std::set<std::set<FaceId>> told;
  for (const RecoveryFailure& f : run->crossings.failures) told.insert({f.faces[0], f.faces[1]});
  EXPECT_EQ(told, (std::set<std::set<FaceId>>{{FaceId(0), FaceId(2)}}));
}

// The certificate says which facets of T_Γ are not those of t_3d; here that is found by comparing the two.
TEST(Certificate, TellsWhatTheMarchBroughtIn) {
  std::size_t brought_in = 0;
  for (const auto& [model, size] : {std::pair{make_cylinder(2, 5), 4.0},
                                    {make_half_ellipsoid(1, 2), 1.0},
                                    {make_half_ellipsoid(1, 2), 0.6},
                                    {make_tube(3, 2.5, 4), 2.0}}) {
    BoundaryRunOptions options{size, 12};
    options.until = Until::tets;
    const auto run = run_boundary(model, options);
    ASSERT_FALSE(HasFailure());
    std::vector<std::vector<FacetKey>> before;
    for (std::size_t f = 0; f < model.faces.size(); ++f)
      before.push_back(facets_of(run->boundary.faces[FaceId(f)], FaceId(f)));
    Context context;
    const auto recovered = recover_faces(*run->conjoint, {0.001}, context);
    ASSERT_TRUE(recovered.ok() && recovered.value().failures.empty());
    ASSERT_EQ(recovered.value().points + recovered.value().edge_splits, 0u) << "so that t_3d is the one of before";
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      const FaceCertificate& c = recovered.value().faces[FaceId(f)];
      std::vector<FacetKey> only_after;
      std::set_difference(c.locked.begin(), c.locked.end(), before[f].begin(), before[f].end(),
                          std::back_inserter(only_after));
      EXPECT_EQ(only_after, std::vector<FacetKey>(c.marched.begin(), c.marched.end()));
      EXPECT_EQ(c.parametric, before[f].size());
      brought_in += only_after.size();
    }
  }
  EXPECT_GT(brought_in, 0u) << "or the test says nothing";
}

TEST(Refinement, CurvesThatMayNotBeSplitStayWhole) {
  const Model model = make_cylinder(1, 5);
  BoundaryRunOptions options{10, 0};
  options.until = Until::tets;
  const auto run = run_boundary(model, options);
  ASSERT_FALSE(HasFailure());
  const auto points_on_curves = [&] {
    std::size_t count = 0;
    for (const CurveMesh& curve : run->boundary.curves) count += curve.vertices.size();
    return count;
  };
  const std::size_t before = points_on_curves();
  SurfaceRefinement refinement;
  refinement.floor = 1e-4;
  refinement.may_split = [](EdgeId) { return false; };
  std::size_t inserted = 0;
  for (int round = 0; round < 3; ++round)
    for (const SurfaceTriangle& t : surface_triangles(run->boundary)) {
      const FaceMesh& mesh = run->boundary.faces[t.face];
      if (!mesh.triangle(t.triangle).alive() || mesh.vertices(t.triangle) != t.vertices) continue;
      if (refine_triangle(*run->conjoint, t.face, t.triangle, refinement).ok()) ++inserted;
    }
  EXPECT_GT(inserted, 0u);
  EXPECT_EQ(points_on_curves(), before);
}

TEST(Classification, VolumesApproachTheCadAsTheSizeFalls) {
  const Model model = make_ball(3);
  const double exact = model.solids[SolidId(0)].volume;
  double previous = exact;
  for (double size : {2.0, 1.0, 0.5}) {
    const auto run = run_boundary(model, {size, 0});
    ASSERT_FALSE(HasFailure());
    const double error = std::abs(run->classified.volumes[SolidId(0)] - exact);
    EXPECT_LT(error, previous);
    previous = error;
  }
  EXPECT_LT(previous, 0.03 * exact);
}

}  // namespace
}  // namespace curvetet::test
