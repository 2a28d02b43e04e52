// Filling alone, before any flip or split was tried: missing segments become edges, missing facets facets.
#include "boundary/fill_holes.h"

#include <gtest/gtest.h>

#include "boundary/reconnect.h"
#include "boundary/surface_triangles.h"
#include "spatial/flips.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

struct Counts {
  std::size_t facets = 0, left = 0;
};

std::unique_ptr<BoundaryRun> tetrahedralized(const Model& model, double size) {
  BoundaryRunOptions options{size, 0};
  options.until = Until::tets;
  options.smooth = false;  // or hardly anything is missing
  return run_boundary(model, options);
}

Counts fill_all(const Model& model, double size) {
  const auto run = tetrahedralized(model, size);
  Counts counts;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceId face(f);
    counts.facets += missing_triangles(*run->conjoint, face).size();
    for (int pass = 0; pass < 3 && !missing_triangles(*run->conjoint, face).empty(); ++pass)
      fill_holes(*run->conjoint, face, true);
    counts.left += missing_triangles(*run->conjoint, face).size();
    for (const SurfaceTriangle& t : surface_triangles(run->boundary.faces[face], face))
      if (const auto facet = run->tets->find_facet(t.vertices[0], t.vertices[1], t.vertices[2]))
        run->tets->lock(*facet, face);
  }
  EXPECT_EQ(run->tets->complex().locked_count() + counts.left, surface_triangles(run->boundary).size());
  return counts;
}

TEST(FillHoles, ClosesWhatTheDelaunayTetrahedralizationsOfThinBodiesLack) {
  Counts sum;
  const auto add = [&](const Model& model, double size) {
    const Counts counts = fill_all(model, size);
    sum.facets += counts.facets;
    sum.left += counts.left;
  };
  for (double size : {1.5, 3.0, 5.0}) {
    for (double wall : {0.2, 0.1}) add(make_nested_balls(10, 10 - wall), size);
    add(make_tube(10, 9.9, 30), size);
    add(make_lens(10, 0.5), size);
  }
  EXPECT_GT(sum.facets, 100U);
  EXPECT_LE(sum.left, sum.facets / 20);
}

TEST(FillHoles, BringsBackSegmentsThatFlipsTookOut) {
  const Model model = make_tube(10, 9, 30);
  const auto run = tetrahedralized(model, 5);
  Tetrahedralization& tets = *run->tets;
  const auto any = [](Vec3, Vec3, Vec3, Vec3) { return 1.0; };
  std::size_t taken = 0;
  for (const Conjoint::Segment& s : run->conjoint->segments()) {
    const auto edge = tets.find_edge(s.a, s.b);
    if (!edge || !remove_edge(tets, *edge, any, 0)) continue;
    ++taken;
    ASSERT_FALSE(tets.find_edge(s.a, s.b));
    const FillResult filled = fill_around_segment(*run->conjoint, s);
    EXPECT_GT(filled.recovered, 0U);
    EXPECT_TRUE(tets.find_edge(s.a, s.b));
  }
  EXPECT_GT(taken, 0U);
}

}  // namespace
}  // namespace curvetet::test
