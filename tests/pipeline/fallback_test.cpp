// Bodies all of whose faces are recovered facet by facet alone, through to the finished mesh.
#include <gtest/gtest.h>

#include <functional>

#include "boundary/fill_holes.h"
#include "pipeline/assemble.h"
#include "quality/validate.h"
#include "support/bodies.h"
#include "support/run_boundary.h"
#include "volume/improve.h"
#include "volume/refine.h"

namespace curvetet::test {
namespace {

struct Case {
  const char* name;
  std::function<Model()> make;
  double size;
};

std::vector<Case> cases() {
  return {
      {"box", [] { return make_box(2, 3, 4); }, 0.9},
      {"boxes",
       [] {
         return make_boxes({1, 2, 1}, 1, 1);
       },
       0.6},
      {"ball", [] { return make_ball(3); }, 1},
      {"ball_coarse", [] { return make_ball(3); }, 6},
      {"cylinder", [] { return make_cylinder(2, 5); }, 0.8},
      {"cylinder_coarse", [] { return make_cylinder(2, 5); }, 3},
      {"frustum", [] { return make_cone(2, 1, 4); }, 1},
      {"cone", [] { return make_cone(2, 0, 4); }, 1},
      {"torus", [] { return make_torus(5, 1); }, 1},
      {"tube", [] { return make_tube(10, 9.5, 30); }, 5},
      {"lens", [] { return make_lens(5, 0.5); }, 6},
      {"thin_shell", [] { return make_shell(10, 9.8); }, 8},
      {"nested_balls", [] { return make_nested_balls(3, 2); }, 1},
      {"half_ellipsoid", [] { return make_half_ellipsoid(1, 3); }, 5},
  };
}

class Fallback : public testing::TestWithParam<std::tuple<Case, bool>> {};

std::unique_ptr<BoundaryRun> recovered_by_fallback(const Model& model, double size, bool as_paper) {
  BoundaryRunOptions options{size, 12};
  options.as_paper = as_paper;
  options.recovery.force_fallback = [](FaceId) { return true; };
  return run_boundary(model, options);
}

void expect_counted(const BoundaryRun& run) {
  for (const FaceCertificate& c : run.recovery.faces) {
    EXPECT_TRUE(c.fallback);
    EXPECT_EQ(c.ladder.fallback.recovered, c.ladder.fallback.tried);
    EXPECT_TRUE(c.marched.empty()) << "recovered by the march";
    for (const RungCounts& rung : {c.ladder.reconnect, c.ladder.refine, c.ladder.volume_points})
      EXPECT_EQ(rung.tried + rung.recovered, 0U);
  }
}

TEST_P(Fallback, RecoversEveryFaceOfAValidMesh) {
  const auto& [body, as_paper] = GetParam();
  const Model model = body.make();
  const auto run = recovered_by_fallback(model, body.size, as_paper);
  for (const RecoveryFailure& f : run->recovery.failures)
    ADD_FAILURE() << f.what << ", face " << f.faces.front().value();
  for (const RecoveryFailure& f : run->classified.failures) ADD_FAILURE() << f.what;
  ASSERT_FALSE(HasFailure());
  for (const std::string& broken : check_recovered(model, *run)) ADD_FAILURE() << broken;
  expect_counted(*run);

  own_points(*run->conjoint);
  Context context;
  ASSERT_TRUE(refine_interior(*run->tets, run->vertices, run->sizes, RefineOptions{}, context).ok());
  ASSERT_TRUE(improve(*run->tets, run->vertices, ImproveOptions{}, context).ok());
  const auto locked = locked_facets(*run->tets, model.faces.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    EXPECT_EQ(facet_hash(locked[FaceId(f)]), facet_hash(run->recovery.faces[FaceId(f)].locked));
  Settings settings;
  settings.unit = "mm";
  const ValidationReport validation = validate(assemble(*run->conjoint, settings), &model, 1, context);
  for (const Finding& f : validation.findings)
    if (f.severity == Severity::error) ADD_FAILURE() << f.check << ": " << f.count;
}

INSTANTIATE_TEST_SUITE_P(Bodies, Fallback, testing::Combine(testing::ValuesIn(cases()), testing::Bool()),
                         [](const auto& tested) {
                           return std::string(std::get<0>(tested.param).name) +
                                  (std::get<1>(tested.param) ? "_as_paper" : "");
                         });

TEST(Fallback, HasSomethingToDo) {
  std::size_t tried = 0;
  for (const Case& body : cases()) {
    const auto run = recovered_by_fallback(body.make(), body.size, false);
    for (const FaceCertificate& c : run->recovery.faces) tried += c.ladder.fallback.tried;
  }
  EXPECT_GT(tried, 0U) << "or the other tests say nothing";
}

}  // namespace
}  // namespace curvetet::test
