// Two curves that leave a vertex side by side and cross within their tolerances: the nodes on the wrong side are moved,
// and nothing else is.
#include "boundary/untangle.h"

#include <gtest/gtest.h>

#include "geometry/analytic.h"

namespace curvetet {
namespace {

constexpr double kDip = 0x1p-10;

/// A triangle with a lower side along y = 0 and an upper one that starts by dipping below it.
FaceInput dipping_triangle() {
  ChainInput lower{0, {VertexId(0U), VertexId(1U)}, {{0, 0}, {0.5, 0}}, false};
  ChainInput right{1, {VertexId(1U), VertexId(2U)}, {{0.5, 0}, {0.5, 0.25}}, false};
  ChainInput upper{2, {VertexId(2U), VertexId(3U), VertexId(0U)}, {{0.5, 0.25}, {0.125, -kDip}, {0, 0}}, false};
  FaceInput input;
  input.loops.push_back({{lower, right, upper}, false});
  return input;
}

bool untangled(FaceInput& input, double tolerance) {
  FaceMesh mesh;
  const std::vector<LoopFault> faults = mesh.build(input);
  EXPECT_FALSE(faults.empty());
  const auto plane = make_plane({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  return untangle(
      faults, *plane, Chart{}, [&](std::int32_t) { return tolerance; }, input);
}

TEST(Untangle, MovesANodeAcrossWithinTheTolerance) {
  FaceInput input = dipping_triangle();
  ASSERT_TRUE(untangled(input, kDip));
  const FaceInput before = dipping_triangle();
  const Vec2 moved = input.loops[0].chains[2].q[1];
  EXPECT_GT(moved.y, 0);
  EXPECT_LT(distance(moved, before.loops[0].chains[2].q[1]), 2 * kDip);
  for (std::size_t c = 0; c < 2; ++c) EXPECT_EQ(input.loops[0].chains[c].q, before.loops[0].chains[c].q);
  FaceMesh mesh;
  EXPECT_TRUE(mesh.build(input).empty());
  EXPECT_TRUE(mesh.check().empty());
}

TEST(Untangle, LeavesWhatTheToleranceDoesNotExplain) {
  FaceInput input = dipping_triangle();
  EXPECT_FALSE(untangled(input, kDip / 8));
  EXPECT_EQ(input.loops[0].chains[2].q, dipping_triangle().loops[0].chains[2].q);
}

/// The upper side comes back below the lower one for several nodes, all of which are on the wrong side.
TEST(Untangle, StraightensBothSidesUpToTheCrossing) {
  FaceInput input = dipping_triangle();
  ChainInput& lower = input.loops[0].chains[0];
  ChainInput& upper = input.loops[0].chains[2];
  lower.vertices = {VertexId(0U), VertexId(4U), VertexId(5U), VertexId(6U), VertexId(1U)};
  lower.q = {{0, 0}, {0.0625, 0}, {0.125, 0}, {0.25, 0}, {0.5, 0}};
  upper.vertices = {VertexId(2U), VertexId(3U), VertexId(7U), VertexId(8U), VertexId(9U), VertexId(0U)};
  upper.q = {{0.5, 0.25}, {0.25, 2 * kDip}, {0.1875, -kDip}, {0.09375, -kDip}, {0.03125, -kDip / 2}, {0, 0}};
  const FaceInput before = input;
  ASSERT_TRUE(untangled(input, kDip));
  FaceMesh mesh;
  EXPECT_TRUE(mesh.build(input).empty());
  EXPECT_TRUE(mesh.check().empty());
  for (std::size_t c : {0, 2}) {
    const ChainInput& now = input.loops[0].chains[c];
    const ChainInput& was = before.loops[0].chains[c];
    EXPECT_EQ(now.q.front(), was.q.front());
    EXPECT_EQ(now.q.back(), was.q.back());
    EXPECT_EQ(now.vertices, was.vertices);
  }
}

/// The same where the two sides end at different chart points of one vertex, with an edge between that is a point.
TEST(Untangle, DrawsTogetherTheChartPointsOfAVertex) {
  ChainInput lower{0, {VertexId(0U), VertexId(4U), VertexId(1U)}, {{0, 0}, {0.25, 0}, {0.5, 0}}, false};
  ChainInput right{1, {VertexId(1U), VertexId(2U)}, {{0.5, 0}, {0.5, 0.25}}, false};
  ChainInput upper{2, {VertexId(2U), VertexId(3U), VertexId(0U)}, {{0.5, 0.25}, {0.125, kDip / 2}, {0, -kDip}}, false};
  ChainInput point{3, {VertexId(0U), VertexId(0U)}, {{0, -kDip}, {0, 0}}, false};
  FaceInput input;
  input.loops.push_back({{lower, right, upper, point}, false});
  ASSERT_TRUE(untangled(input, kDip));
  FaceMesh mesh;
  EXPECT_TRUE(mesh.build(input).empty());
  EXPECT_EQ(input.loops[0].chains[0].q.front(), input.loops[0].chains[2].q.back());
}

}  // namespace
}  // namespace curvetet
