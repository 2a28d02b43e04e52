// Two curves that leave a vertex side by side and cross within their tolerances: the node on the wrong side is moved,
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

}  // namespace
}  // namespace curvetet
