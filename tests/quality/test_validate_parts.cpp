// Meshes in parts that overlap: sound parts pass, and what is spoiled in one of them is found.
#include <gtest/gtest.h>

#include <algorithm>

#include "quality/validate_parts.h"
#include "sample_meshes.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

bool has(const ValidationReport& report, const std::string& check) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const Finding& f) { return f.check == check && f.severity == Severity::error; });
}

/// The same mesh twice, the second a little to the side.
Mesh twice(const Mesh& one) {
  Mesh both = one;
  const auto n = static_cast<std::uint32_t>(one.points.size());
  for (Point p : one.points) both.points.push_back({p[0] + 0.3, p[1] + 0.1, p[2] + 0.2});
  both.nodes.insert(both.nodes.end(), one.nodes.begin(), one.nodes.end());
  const auto shifted = [&](auto element) {
    for (std::uint32_t& v : element) v += n;
    return element;
  };
  for (const auto& t : one.tets) both.tets.push_back(shifted(t));
  for (const auto& t : one.triangles) both.triangles.push_back(shifted(t));
  for (const auto& s : one.segments) both.segments.push_back(shifted(s));
  both.tet_solid.insert(both.tet_solid.end(), one.tet_solid.begin(), one.tet_solid.end());
  both.triangle_face.insert(both.triangle_face.end(), one.triangle_face.begin(), one.triangle_face.end());
  both.segment_edge.insert(both.segment_edge.end(), one.segment_edge.begin(), one.segment_edge.end());
  return both;
}

class ValidateParts : public testing::Test {
 protected:
  Model model = test::make_boxes({2}, 3, 1);
  Mesh mesh = test::mesh_boxes(model, {2}, 3, 1, 2);
  Context context;
};

TEST_F(ValidateParts, APartThatIsTheWholeIsJudgedAsTheWhole) {
  const ValidationReport whole = validate(mesh, &model, 1, context);
  const ValidationReport parts = validate_parts(mesh, &model, 1, context);
  EXPECT_TRUE(parts.valid());
  EXPECT_EQ(parts.solid_volumes, whole.solid_volumes);
  EXPECT_EQ(parts.quality.worst_dihedral, whole.quality.worst_dihedral);
  EXPECT_EQ(parts.quality.radius_ratio.bins, whole.quality.radius_ratio.bins);
  EXPECT_DOUBLE_EQ(parts.quality.radius_ratio.mean, whole.quality.radius_ratio.mean);
}

TEST_F(ValidateParts, PartsMayOverlap) {
  const Mesh both = twice(mesh);
  EXPECT_FALSE(validate(both, nullptr, 1, context).valid());
  const ValidationReport parts = validate_parts(both, nullptr, 1, context);
  EXPECT_TRUE(parts.valid());
  EXPECT_NEAR(parts.solid_volumes.front(), 12, 1e-9);
}

TEST_F(ValidateParts, EachPartIsHeldAgainstTheBody) {
  // The second copy lies off the faces.
  const ValidationReport parts = validate_parts(twice(mesh), &model, 1, context);
  EXPECT_FALSE(parts.valid());
  EXPECT_TRUE(has(parts, "triangle_off_face") || has(parts, "vertex_off_face") || has(parts, "corner_off_vertex"));
}

TEST_F(ValidateParts, WhatIsSpoiledInOnePartIsFound) {
  Mesh both = twice(mesh);
  std::swap(both.tets.back()[0], both.tets.back()[1]);
  EXPECT_TRUE(has(validate_parts(both, nullptr, 1, context), "negative_tet"));
  both = twice(mesh);
  both.tets.pop_back();
  both.tet_solid.pop_back();
  EXPECT_FALSE(validate_parts(both, nullptr, 1, context).valid());
  both = twice(mesh);
  both.triangles.push_back({0, 1, static_cast<std::uint32_t>(both.points.size()) - 1});
  both.triangle_face.push_back(0);
  EXPECT_FALSE(validate_parts(both, nullptr, 1, context).valid());
  both = twice(mesh);
  both.tet_solid.pop_back();
  EXPECT_FALSE(validate_parts(both, nullptr, 1, context).valid());
}

TEST_F(ValidateParts, ASolidWithoutTetsIsMissed) {
  const Model two = test::make_boxes({2, 1}, 3, 1);
  Mesh whole = test::mesh_boxes(two, {2, 1}, 3, 1, 2);
  EXPECT_TRUE(validate_parts(whole, &two, 1, context).valid());
  EXPECT_TRUE(has(validate_parts(mesh, &two, 1, context), "empty_solid"));
  EXPECT_FALSE(validate_parts(Mesh{}, &two, 1, context).valid());
}

}  // namespace
}  // namespace curvetet
