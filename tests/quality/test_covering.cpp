// The proof that tets do not overlap, beside a search for vertices in foreign tets.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mesh/tet_complex.h"
#include "quality/checks.h"
#include "quality/exact.h"
#include "sample_meshes.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

using checks::vec;

/// Tets alone; the labels of faces are not looked at.
void add(Mesh& mesh, const Mesh& other, double scale, Vec3 by) {
  const auto shift = static_cast<std::uint32_t>(mesh.points.size());
  for (const Point& p : other.points)
    mesh.points.push_back({scale * p[0] + by.x, scale * p[1] + by.y, scale * p[2] + by.z});
  for (auto t : other.tets) {
    for (std::uint32_t& v : t) v += shift;
    mesh.tets.push_back(t);
    mesh.tet_solid.push_back(0);
  }
  if (mesh.solids.empty()) mesh.solids.resize(1);
}

Mesh ball() {
  const Model model = test::make_ball(2);
  return test::mesh_balls(model, {2}, true, {0}, 1);
}

/// From 2 to 3.
Mesh shell() {
  const Model model = test::make_shell(3, 2);
  return test::mesh_balls(model, {2, 3}, false, {0}, 1);
}

struct Verdict {
  bool embedded_boundary = false, covered_once = false;
};

Verdict judge(const Mesh& mesh) {
  Context context;
  checks::Findings findings;
  checks::Topology topology = checks::check_tets(mesh, context, findings);
  checks::check_closedness(mesh, nullptr, topology, findings);
  const BoxTree tree = checks::tree_of_boundary(mesh, topology);
  checks::check_self_intersection(mesh, topology, tree, context, findings);
  return {!findings.any_error(), checks::is_covered_once(mesh, topology, tree)};
}

bool has_vertex_in_foreign_tet(const Mesh& mesh) {
  const auto holds = [&](const std::array<std::uint32_t, 4>& t, std::uint32_t v) {
    if (std::find(t.begin(), t.end(), v) != t.end()) return false;
    return std::all_of(kFacet.begin(), kFacet.end(), [&](const std::array<int, 3>& f) {
      const auto corner = [&](std::size_t i) { return vec(mesh.points[t[static_cast<std::size_t>(f[i])]]); };
      return exact::orientation(corner(0), corner(1), corner(2), vec(mesh.points[v])) >= 0;
    });
  };
  for (const auto& t : mesh.tets)
    for (std::uint32_t v = 0; v < mesh.points.size(); ++v)
      if (holds(t, v)) return true;
  return false;
}

TEST(Covering, IsProvedForGoodMeshes) {
  Mesh mesh;
  add(mesh, shell(), 1, {});
  add(mesh, shell(), 0.5, {0.1, 0, 0});            // in the hollow
  add(mesh, ball(), 0.3, {0.1, 0, 0});             // in the hollow's hollow
  add(mesh, ball(), 1, {9, 0, 0});                 // beside them
  add(mesh, ball(), 0.125, {0, 0, 0x1p-4 + 3.5});  // above
  const Verdict verdict = judge(mesh);
  EXPECT_TRUE(verdict.embedded_boundary);
  EXPECT_TRUE(verdict.covered_once);
}

TEST(Covering, IsProvedWhereSolidsTouch) {
  const Model model = test::make_boxes({1, 2, 0.5}, 3, 1);
  EXPECT_TRUE(judge(test::mesh_boxes(model, {1, 2, 0.5}, 3, 1, 2)).covered_once);
}

TEST(Covering, IsRefusedForABallInAWall) {
  Mesh mesh;
  add(mesh, shell(), 1, {});
  add(mesh, shell(), 0.5, {0.1, 0, 0});
  add(mesh, ball(), 0.1, {2.5, 0, 0});
  const Verdict verdict = judge(mesh);
  EXPECT_TRUE(verdict.embedded_boundary);
  EXPECT_FALSE(verdict.covered_once);
}

/// Across an edge of four facets a sheet does not go on: one tet within another, from which it has an edge.
TEST(Covering, IsRefusedForATetWithinAnEdgeOfAnother) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {1, 0.2, 0.1}, {1, 0.1, 0.2}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 4, 5}};
  mesh.tet_solid = {0, 0};
  mesh.solids.resize(1);
  const Verdict verdict = judge(mesh);
  EXPECT_TRUE(verdict.embedded_boundary);
  EXPECT_FALSE(verdict.covered_once);
}

TEST(Covering, AgreesWithTheSearch) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int once = 0, twice = 0;
  for (int round = 0; round < 120; ++round) {
    Mesh mesh;
    add(mesh, shell(), 1, {});
    for (int k = 0; k < 2; ++k) {
      const double scale = 0.05 + 0.2 * std::abs(uniform(random));
      add(mesh, k == 0 ? shell() : ball(), scale, {3 * uniform(random), 3 * uniform(random), 3 * uniform(random)});
    }
    const Verdict verdict = judge(mesh);
    if (!verdict.embedded_boundary) continue;
    ASSERT_EQ(verdict.covered_once, !has_vertex_in_foreign_tet(mesh)) << "round " << round;
    ++(verdict.covered_once ? once : twice);
  }
  EXPECT_GT(once, 5);
  EXPECT_GT(twice, 5);
}

}  // namespace
}  // namespace curvetet
