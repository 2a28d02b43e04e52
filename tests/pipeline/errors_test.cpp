// Whose fault a failed recovery is: ours, or that of a body whose edges lie off their faces.
#include <gtest/gtest.h>

#include "geometry/analytic.h"
#include "pipeline/report_builder.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

TEST(RecoveryErrors, AnEdgeOffItsFaceIsTheInputsFaultBelowItsDistance) {
  Model model = test::make_box(1, 1, 1);
  ModelEdge& edge = model.edges[EdgeId(0)];
  const FaceId face = edge.faces.front();
  const Vec3 start = edge.curve->value(edge.low), end = edge.curve->value(edge.high);
  const Vec3 off = 0.01 * model.faces[face].surface->normal(0.5 * (model.faces[face].low + model.faces[face].high));
  const double range = edge.high - edge.low;
  edge.curve = make_line(start + off - (edge.low / range) * (end - start), normalized(end - start),
                         distance(start, end) / range);
  Settings settings;
  settings.unit = "mm";
  RecoveryFailure failure;
  failure.faces = {face};
  failure.what = "facets of the surface mesh cross";
  failure.size = 0.001;
  const Error fine = to_error(failure, model, settings);
  EXPECT_EQ(fine.code, ErrorCode::bad_face);
  EXPECT_NE(fine.message.find("does not lie on it"), std::string::npos) << fine.message;
  failure.size = 0.1;
  EXPECT_EQ(to_error(failure, model, settings).code, ErrorCode::recovery_failed);
}

TEST(RecoveryErrors, FacesOfTwoSolidsThatCrossMayBeMeshedApart) {
  const auto hint = [](const Model& model, FaceId a, FaceId b) {
    RecoveryFailure failure;
    failure.faces = {a, b};
    return crossing_hint(failure, model);
  };
  const auto offers = [](const std::string& words) { return words.find("--conformal off") != std::string::npos; };
  const Model joined = test::make_boxes({1, 1}, 1, 1);  // meshed together even with --conformal off
  Model apart = test::make_shell(3, 2);
  EXPECT_FALSE(offers(hint(apart, FaceId(0), FaceId(1))));
  const SolidId second = apart.solids.push_back(apart.solids[SolidId(0)]);
  apart.faces[FaceId(1)].front = apart.faces[FaceId(1)].back = SolidId();
  (apart.faces[FaceId(1)].reversed ? apart.faces[FaceId(1)].front : apart.faces[FaceId(1)].back) = second;
  apart.solids[SolidId(0)].faces = {FaceId(0)};
  apart.solids[second].faces = {FaceId(1)};
  EXPECT_TRUE(offers(hint(apart, FaceId(0), FaceId(1))));
  for (std::size_t f = 1; f < joined.faces.size(); ++f) EXPECT_FALSE(offers(hint(joined, FaceId(0), FaceId(f))));
}

TEST(RecoveryErrors, CrossingsThatNoSizeHelpsSayWhatToDo) {
  RecoveryFailure failure;
  failure.faces = {FaceId(0), FaceId(1)};
  failure.crossing = true;
  Settings settings;
  settings.unit = "mm";
  const Model model = test::make_pierced_ball(5, 1, 14);
  EXPECT_EQ(to_error(failure, model, settings).hint, crossing_hint(failure, model));
  failure.size = 0.1;
  EXPECT_NE(to_error(failure, model, settings).hint.find("--face-size"), std::string::npos);
}

}  // namespace
}  // namespace curvetet
