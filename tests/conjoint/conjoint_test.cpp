// One vertex into all triangulations or into none: after any sequence of insertions, accepted or refused, every face
// mesh is valid, every vertex of a face mesh is in the tetrahedralization, and curves and face meshes agree.
#include "conjoint/conjoint.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "boundary/refine_surface.h"
#include "spatial/check.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

void expect_consistent(const Model& model, BoundaryRun& run) {
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceMesh& mesh = run.boundary.faces[FaceId(f)];
    for (const std::string& broken : mesh.check()) ADD_FAILURE() << "face " << f << ": " << broken;
    for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
      if (!mesh.triangle(TriangleId(t)).alive()) continue;
      for (VertexId v : mesh.vertices(TriangleId(t))) EXPECT_TRUE(run.tets->contains(v));
    }
  }
  for (const Conjoint::Segment& s : run.conjoint->segments()) {
    EXPECT_EQ(run.conjoint->segment_edge(s.a, s.b), s.edge);
    EXPECT_TRUE(run.tets->contains(s.a) && run.tets->contains(s.b));
  }
  for (const std::string& broken : check_tetrahedralization(*run.tets, false)) ADD_FAILURE() << broken;
}

std::unique_ptr<BoundaryRun> tetrahedralized(const Model& model, double size) {
  BoundaryRunOptions options{size, 12};
  options.until = Until::tets;
  return run_boundary(model, options);
}

TEST(Conjoint, SplittingEverySegmentKeepsAllTriangulationsTogether) {
  for (const Model& model : {make_box(2, 3, 4), make_cylinder(2, 5), make_cone(2, 1, 4), make_tube(3, 2, 4)}) {
    const auto run = tetrahedralized(model, 1.5);
    ASSERT_FALSE(HasFailure());
    const std::size_t before = run->conjoint->segments().size();
    std::size_t split = 0;
    for (const Conjoint::Segment& s : run->conjoint->segments())
      split += run->conjoint->split_segment(s.edge, s.a, s.b, Origin::stage_two).ok() ? 1U : 0U;
    EXPECT_GT(split, 0u);
    EXPECT_EQ(run->conjoint->segments().size(), before + split);
    expect_consistent(model, *run);
  }
}

TEST(Conjoint, RefiningEveryTriangleKeepsAllTriangulationsTogether) {
  for (const Model& model : {make_box(2, 3, 4), make_torus(5, 1), make_cylinder(2, 5)}) {
    const auto run = tetrahedralized(model, 2);
    ASSERT_FALSE(HasFailure());
    SurfaceRefinement refinement;
    refinement.floor = 1e-3;
    std::size_t inserted = 0;
    for (const SurfaceTriangle& t : surface_triangles(run->boundary)) {
      const FaceMesh& mesh = run->boundary.faces[t.face];
      if (mesh.triangle(t.triangle).alive() && mesh.vertices(t.triangle) == t.vertices)
        inserted += refine_triangle(*run->conjoint, t.face, t.triangle, refinement).ok() ? 1U : 0U;
    }
    EXPECT_GT(inserted, 0u);
    expect_consistent(model, *run);
  }
}

TEST(Conjoint, RefusalsChangeNothing) {
  const Model model = make_cylinder(2, 5);
  const auto run = tetrahedralized(model, 1.5);
  ASSERT_FALSE(HasFailure());
  const auto before = run->conjoint->segments();
  const VertexId a = before.front().a;
  EXPECT_EQ(run->conjoint->split_segment(EdgeId(0), a, a, Origin::stage_two).refusal, ConjointRefusal::no_segment);
  EXPECT_FALSE(run->conjoint->segment_edge(a, a).valid());
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    FaceMesh& mesh = run->boundary.faces[FaceId(f)];
    for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
      const TriangleId id(t);
      if (!mesh.triangle(id).alive()) continue;
      const Vec2 at_node = mesh.node(mesh.triangle(id).node[0]).q;
      EXPECT_FALSE(run->conjoint->insert_on_face(FaceId(f), at_node, id, Origin::stage_two).ok());
    }
  }
  EXPECT_EQ(run->conjoint->segments().size(), before.size());
  expect_consistent(model, *run);
}

TEST(Conjoint, LockedFacesRefuseWhatWouldSplitThem) {
  const Model model = make_box(2, 3, 4);
  const auto run = run_boundary(model, {1.5, 12});
  ASSERT_FALSE(HasFailure());
  for (const Conjoint::Segment& s : run->conjoint->segments()) {
    const auto done = run->conjoint->split_segment(s.edge, s.a, s.b, Origin::stage_two);
    EXPECT_EQ(done.refusal, ConjointRefusal::locked_cavity);
  }
  const auto locked = locked_facets(*run->tets, model.faces.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    EXPECT_EQ(locked[FaceId(f)], run->recovery.faces[FaceId(f)].locked);
}

}  // namespace
}  // namespace curvetet::test
