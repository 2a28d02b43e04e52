// Parts of bodies, checked against what can be counted by hand.
#include <gtest/gtest.h>

#include "geometry/check.h"
#include "geometry/parts.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

/// Two bodies as one that shares nothing.
Model side_by_side(const Model& one, const Model& two) {
  Model both = one;
  const auto solids = static_cast<std::uint32_t>(one.solids.size()),
             faces = static_cast<std::uint32_t>(one.faces.size());
  const auto edges = static_cast<std::uint32_t>(one.edges.size()),
             vertices = static_cast<std::uint32_t>(one.vertices.size());
  const auto shift = [](auto id, std::uint32_t by) { return id.valid() ? decltype(id)(id.value() + by) : id; };
  for (ModelVertex v : two.vertices) both.vertices.push_back(v);
  for (ModelEdge e : two.edges) {
    e.start = shift(e.start, vertices);
    e.end = shift(e.end, vertices);
    for (FaceId& f : e.faces) f = shift(f, faces);
    both.edges.push_back(e);
  }
  for (ModelFace f : two.faces) {
    for (Loop& loop : f.loops)
      for (EdgeUse& use : loop.uses) use.edge = shift(use.edge, edges);
    f.front = shift(f.front, solids);
    f.back = shift(f.back, solids);
    both.faces.push_back(f);
  }
  for (ModelSolid s : two.solids) {
    for (FaceId& f : s.faces) f = shift(f, faces);
    both.solids.push_back(s);
  }
  return both;
}

TEST(Parts, SolidsThatShareFacesStayTogether) {
  const Model row = test::make_boxes({1, 2, 0.5}, 2, 1);
  EXPECT_EQ(parts_of(row), (std::vector<std::vector<SolidId>>{{SolidId(0), SolidId(1), SolidId(2)}}));
  const Model nested = test::make_nested_balls(10, 5);
  EXPECT_EQ(parts_of(nested).size(), 1U);
  const Model apart = side_by_side(row, test::make_ball(1));
  EXPECT_EQ(parts_of(apart), (std::vector<std::vector<SolidId>>{{SolidId(0), SolidId(1), SolidId(2)}, {SolidId(3)}}));
}

TEST(Parts, AllSolidsTogetherAreTheBody) {
  for (const Model& body : {test::make_boxes({1, 2}, 2, 1), test::make_nested_balls(10, 5), test::make_torus(5, 1)}) {
    std::vector<SolidId> all;
    for (std::size_t s = 0; s < body.solids.size(); ++s) all.emplace_back(s);
    const Part part = make_part(body, all);
    EXPECT_TRUE(check_model(part.model).empty());
    EXPECT_EQ(part.model.faces.size(), body.faces.size());
    EXPECT_EQ(part.model.edges.size(), body.edges.size());
    EXPECT_EQ(part.model.vertices.size(), body.vertices.size());
    EXPECT_EQ(part.model.diagonal(), body.diagonal());
  }
}

TEST(Parts, OneOfTwoIsSoundAndKeepsItsIds) {
  const Model ball = test::make_ball(1), row = test::make_boxes({1, 2, 0.5}, 2, 1);
  const Model both = side_by_side(ball, row);
  const Part part = make_part(both, {SolidId(1), SolidId(2), SolidId(3)});
  EXPECT_TRUE(check_model(part.model).empty());
  ASSERT_EQ(part.model.faces.size(), row.faces.size());
  EXPECT_EQ(part.model.edges.size(), row.edges.size());
  EXPECT_EQ(part.model.vertices.size(), row.vertices.size());
  for (std::size_t f = 0; f < row.faces.size(); ++f) {
    EXPECT_EQ(part.faces[FaceId(f)].value(), f + ball.faces.size());
    EXPECT_EQ(part.model.faces[FaceId(f)].label.cad_id, row.faces[FaceId(f)].label.cad_id);
    EXPECT_EQ(part.model.faces[FaceId(f)].front, row.faces[FaceId(f)].front);
    EXPECT_EQ(part.model.faces[FaceId(f)].back, row.faces[FaceId(f)].back);
  }
  EXPECT_EQ(part.solids[SolidId(0)], SolidId(1));
}

TEST(Parts, ASharedFaceOfASolidAloneHasNothingBeside) {
  const Model row = test::make_boxes({1, 2}, 2, 1);
  const Part part = make_part(row, {SolidId(1)});
  EXPECT_TRUE(check_model(part.model).empty());
  EXPECT_EQ(part.model.faces.size(), 6U);
  EXPECT_EQ(part.model.edges.size(), 12U);
  EXPECT_EQ(part.model.vertices.size(), 8U);
  for (const ModelFace& face : part.model.faces) EXPECT_NE(face.front.valid(), face.back.valid());
  for (const ModelEdge& edge : part.model.edges) EXPECT_EQ(edge.faces.size(), 2U);
}

}  // namespace
}  // namespace curvetet
