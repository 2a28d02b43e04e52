// Construction of face meshes: domains of all kinds, and the faults of loops that bound none.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "oracle/planar_naive.h"
#include "planar/face_mesh.h"
#include "planar/shapes.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

using testing::area;
using testing::circle;
using testing::closed_loop;
using testing::open_chain;
using testing::rectangle;
using testing::reversed;

void expect_valid(const FaceMesh& mesh) {
  for (const std::string& what : mesh.check()) ADD_FAILURE() << what;
}

FaceMesh built(const FaceInput& input) {
  FaceMesh mesh;
  for (const LoopFault& f : mesh.build(input)) {
    ADD_FAILURE() << f.what << ": use " << f.use_a << " segment " << f.segment_a << ", use " << f.use_b << " segment "
                  << f.segment_b;
  }
  expect_valid(mesh);
  return mesh;
}

bool names(const std::vector<LoopFault>& faults, const std::string& what) {
  return std::any_of(faults.begin(), faults.end(), [&](const LoopFault& f) { return f.what == what; });
}

/// Sides of triangles that carry a use.
std::size_t sides_of(const FaceMesh& mesh, std::int32_t use) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    for (const std::int32_t u : mesh.triangle(TriangleId(t)).use)
      count += mesh.triangle(TriangleId(t)).alive() && u == use;
  }
  return count;
}

TEST(Build, Square) {
  const FaceMesh mesh = built({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0)}, {}});
  EXPECT_EQ(mesh.triangle_count(), 2U);
  EXPECT_EQ(area(mesh), 1.0);
  EXPECT_EQ(sides_of(mesh, 0), 4U);
}

TEST(Build, PlateWithHoles) {
  FaceInput input{{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0, 0)}, {}};
  std::uint32_t first = 100;
  double expected = 1;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const auto hole = circle({-0.375 + 0.25 * i, -0.375 + 0.25 * j}, 0.1, 12);
      input.loops.push_back(closed_loop(reversed(hole), first, 1 + i * 4 + j));
      first += 100;
      expected -= 6 * 0.01 * std::sin(std::numbers::pi / 6);
    }
  }
  const FaceMesh mesh = built(input);
  EXPECT_NEAR(area(mesh), expected, 1e-9);
  for (int use = 1; use <= 16; ++use) EXPECT_EQ(sides_of(mesh, use), 12U);
}

TEST(Build, CrossingLoopsAreNamed) {
  FaceMesh mesh;
  const auto faults = mesh.build({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0, 0),
                                   closed_loop(reversed(rectangle(0.25, -0.1, 0.75, 0.1)), 10, 7)},
                                  {}});
  ASSERT_EQ(faults.size(), 2U);
  for (const LoopFault& f : faults) {
    EXPECT_EQ(f.what, "crossing");
    EXPECT_EQ(f.use_a, 0);
    EXPECT_EQ(f.segment_a, 1U);
    EXPECT_EQ(f.use_b, 7);
  }
  EXPECT_EQ(mesh.triangle_count(), 0U);
}

TEST(Build, SelfCrossingLoop) {
  FaceMesh mesh;
  EXPECT_TRUE(names(mesh.build({{closed_loop({{0, 0}, {0.5, 0.5}, {0.5, 0}, {0, 0.5}}, 0)}, {}}), "crossing"));
}

TEST(Build, HoleOutsideOfTheRimIsNotNested) {
  FaceMesh mesh;
  const auto faults = mesh.build({{closed_loop(rectangle(-0.5, -0.5, 0.25, 0.5), 0, 3),
                                   closed_loop(reversed(rectangle(0.3, -0.1, 0.4, 0.1)), 10, 4)},
                                  {}});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].what, "not nested");
  EXPECT_EQ(faults[0].use_a, 4);
  EXPECT_EQ(faults[0].use_b, 3);
  EXPECT_EQ(faults[0].segment_b, 1U);
}

TEST(Build, InvertedOuterLoop) {
  FaceMesh mesh;
  EXPECT_TRUE(names(mesh.build({{closed_loop(reversed(rectangle(-0.5, -0.5, 0.25, 0.5)), 0)}, {}}), "inverted"));
}

TEST(Build, NestedLoopsOfOneSense) {
  FaceMesh mesh;
  EXPECT_TRUE(names(mesh.build({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0, 0),
                                 closed_loop(rectangle(-0.1, -0.1, 0.1, 0.1), 10, 1)},
                                {}}),
                    "not nested"));
}

TEST(Build, SeamOfACylinder) {
  // Bottom circle, seam up, top circle back, seam down: vertices 0.. on the bottom, 10.. on the top, 20.. on the seam.
  ChainInput bottom{0, {}, {}, false}, up{1, {}, {}, false}, top{2, {}, {}, false}, down{3, {}, {}, false};
  for (std::uint32_t i = 0; i <= 6; ++i) {
    bottom.vertices.push_back(VertexId(i % 6));
    bottom.q.push_back({-0.375 + 0.125 * i, -0.25});
    top.vertices.push_back(VertexId(10 + (6 - i) % 6));
    top.q.push_back({0.375 - 0.125 * i, 0.25});
  }
  const std::vector<VertexId> seam{VertexId(0U), VertexId(20U), VertexId(21U), VertexId(10U)};
  up.vertices = seam;
  down.vertices = {seam.rbegin(), seam.rend()};
  up.q = {{0.375, -0.25}, {0.375, -0.125}, {0.375, 0.125}, {0.375, 0.25}};
  down.q = {{-0.375, 0.25}, {-0.375, 0.125}, {-0.375, -0.125}, {-0.375, -0.25}};
  const FaceMesh mesh = built({{{{bottom, up, top, down}, false}}, {}});
  EXPECT_EQ(area(mesh), 0.375);
  EXPECT_EQ(mesh.nodes_of(VertexId(20U)).size(), 2U);
  EXPECT_EQ(mesh.nodes_of(VertexId(1U)).size(), 1U);
  EXPECT_EQ(mesh.nodes_of(VertexId(999U)).size(), 0U);
}

TEST(Build, SlitFromTheRimAndFreeSlit) {
  // A rectangle whose loop runs into the domain and back along the same points; and an open two-sided chain.
  ChainInput rim{0, {}, {}, false}, in{1, {}, {}, false}, out{2, {}, {}, false};
  rim.vertices = {VertexId(0U), VertexId(1U), VertexId(2U), VertexId(3U), VertexId(0U)};
  rim.q = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}};
  in.vertices = {VertexId(0U), VertexId(5U), VertexId(6U)};
  in.q = {{-0.5, -0.5}, {-0.25, -0.25}, {-0.25, 0}};
  out.vertices = {in.vertices.rbegin(), in.vertices.rend()};
  out.q = {in.q.rbegin(), in.q.rend()};
  const FaceMesh mesh =
      built({{{{rim, in, out}, false}, open_chain({{10, {0.1, 0.1}}, {11, {0.3, 0.2}}, {12, {0.3, 0.4}}}, 8)}, {}});
  EXPECT_EQ(area(mesh), 1.0);
  EXPECT_EQ(sides_of(mesh, 1), 2U);
  EXPECT_EQ(sides_of(mesh, 2), 2U);
  EXPECT_EQ(sides_of(mesh, 8), 4U);
}

TEST(Build, PinchedLoops) {
  // Two squares that share one corner, in one loop; and a hole that touches the rim at a vertex.
  ChainInput eight{0, {}, {}, false};
  for (const std::uint32_t v : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 3U, 0U}) eight.vertices.push_back(VertexId(v));
  // 3 is the pinch at the origin
  eight.q = {{-0.5, 0}, {-0.5, -0.5}, {0, -0.5}, {0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}, {0, 0}, {-0.5, 0}};
  const FaceMesh mesh = built({{{{eight}, false}}, {}});
  EXPECT_EQ(area(mesh), 0.5);
  std::vector<TriangleId> around;
  mesh.star(mesh.nodes_of(VertexId(3U)).front(), around);
  EXPECT_GE(around.size(), 2U);

  LoopInput hole = closed_loop({{0.5, 0}, {0.25, -0.0625}, {0.25, 0.0625}}, 10, 1);
  hole.chains[0].vertices.front() = hole.chains[0].vertices.back() = VertexId(1U);
  const FaceMesh touching = built({{closed_loop({{-0.5, -0.5}, {0.5, 0}, {-0.5, 0.5}}, 0, 0), hole}, {}});
  EXPECT_LT(area(touching), 0.5);
}

TEST(Build, PolesAndCollapsedSegments) {
  // A degenerate edge is a chain of nodes with one vertex; two of them at one point are one node.
  ChainInput pole{
      0, {VertexId(7U), VertexId(7U), VertexId(7U), VertexId(7U)}, {{-0.5, 0}, {0, 0}, {0, 0}, {0.5, 0}}, false};
  ChainInput rest{1,
                  {VertexId(7U), VertexId(1U), VertexId(2U), VertexId(7U)},
                  {{0.5, 0}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, 0}},
                  false};
  const FaceMesh mesh = built({{{{pole, rest}, false}}, {}});
  EXPECT_EQ(mesh.nodes_of(VertexId(7U)).size(), 3U);
  FaceMesh other;
  pole.vertices[2] = VertexId(8U);
  EXPECT_TRUE(names(other.build({{{{pole, rest}, false}}, {}}), "segment of no length"));
}

TEST(Build, SpursAtOneVertexAreLeftOut) {
  // Degenerate edges that begin and end at one chart point, on both sides of the rim.
  for (const double x : {-0.25, 0.25}) {
    ChainInput rim{0, {}, {}, false}, spur{1, {}, {}, false};
    rim.vertices = {VertexId(0U), VertexId(1U), VertexId(2U), VertexId(0U)};
    rim.q = {{0, 0}, {0.5, -0.25}, {0.5, 0.25}, {0, 0}};
    spur.vertices.assign(5, VertexId(0U));
    spur.q = {{0, 0}, {0.5 * x, 0}, {x, 0}, {0.5 * x, 0}, {0, 0}};
    const FaceMesh mesh = built({{{{rim, spur}, false}}, {}});
    EXPECT_EQ(mesh.triangle_count(), 1U);
    EXPECT_EQ(mesh.node_count(), 3U);
  }
}

TEST(Build, MalformedInputIsAFault) {
  FaceMesh mesh;
  EXPECT_FALSE(mesh.build({}).empty());
  EXPECT_FALSE(mesh.build({{LoopInput{}}, {}}).empty());
  LoopInput loop = closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0);
  loop.chains[0].q.pop_back();
  EXPECT_TRUE(names(mesh.build({{loop}, {}}), "malformed chain"));
  loop = closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0);
  loop.chains[0].q[2].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(names(mesh.build({{loop}, {}}), "beyond the chart"));
  loop.chains[0].q[2].x = 5;
  EXPECT_TRUE(names(mesh.build({{loop}, {}}), "beyond the chart"));
  loop = closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0);
  loop.chains[0].vertices.back() = VertexId(77U);
  EXPECT_TRUE(names(mesh.build({{loop}, {}}), "open loop"));
}

TEST(Build, IsolatedVertices) {
  const LoopInput square = closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0);
  const FaceMesh mesh =
      built({{square}, {{VertexId(50U), {0.125, 0.25}}, {VertexId(51U), {0, 0}}, {VertexId(0U), {-0.5, -0.5}}}});
  EXPECT_EQ(mesh.nodes_of(VertexId(50U)).size(), 1U);
  EXPECT_EQ(mesh.node_count(), 6U);
  FaceMesh other;
  EXPECT_FALSE(other.build({{square}, {{VertexId(50U), {0.5, 0.25}}}}).empty());
  EXPECT_FALSE(other.build({{square}, {{VertexId(50U), {0.75, 0.25}}}}).empty());
  EXPECT_FALSE(other.build({{square}, {{VertexId(50U), {0, 0}}, {VertexId(51U), {0, 0}}}}).empty());
}

TEST(Build, FreeSlitAsALoop) {
  ChainInput there{1, {VertexId(10U), VertexId(11U), VertexId(12U)}, {{0, 0}, {0.25, 0}, {0.25, 0.25}}, false};
  ChainInput back{2, {VertexId(12U), VertexId(11U), VertexId(10U)}, {{0.25, 0.25}, {0.25, 0}, {0, 0}}, false};
  const FaceMesh mesh = built({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0), {{there, back}, false}}, {}});
  EXPECT_EQ(area(mesh), 1.0);
  EXPECT_EQ(sides_of(mesh, 1), 2U);
  EXPECT_EQ(sides_of(mesh, 2), 2U);
  FaceMesh other;
  EXPECT_TRUE(names(other.build({{{{there, back}, false}}, {}}), "inverted"));
}

/// Winding number of all one-sided segments around a point on none of them.
int winding(const FaceInput& input, Vec2 p) {
  int sum = 0;
  for (const LoopInput& loop : input.loops) {
    for (const ChainInput& chain : loop.chains) {
      for (std::size_t i = 0; i + 1 < chain.q.size(); ++i) {
        const Vec2 a = chain.q[i], b = chain.q[i + 1];
        if (a.y <= p.y && p.y < b.y && orient2d(a, b, p) > 0) ++sum;
        if (b.y <= p.y && p.y < a.y && orient2d(a, b, p) < 0) --sum;
      }
    }
  }
  return sum;
}

struct Segment {
  VertexId va, vb;
  Vec2 a, b;
};

/// Whether two segments may not be in one input, by definition.
bool in_conflict(const Segment& s, const Segment& t) {
  const auto same = [](VertexId v, Vec2 p, VertexId w, Vec2 q) { return v == w && p == q; };
  const bool aa = same(s.va, s.a, t.va, t.a), ab = same(s.va, s.a, t.vb, t.b);
  const bool ba = same(s.vb, s.b, t.va, t.a), bb = same(s.vb, s.b, t.vb, t.b);
  if (aa && bb) return true;
  if (ab && ba) return false;
  const auto beyond = [](Vec2 common, Vec2 p, Vec2 q) {
    return oracle::on_segment(common, p, q) || oracle::on_segment(common, q, p);
  };
  if (aa) return beyond(s.a, s.b, t.b);
  if (ab) return beyond(s.a, s.b, t.a);
  if (ba) return beyond(s.b, s.a, t.b);
  if (bb) return beyond(s.b, s.a, t.a);
  return oracle::segments_meet(s.a, s.b, t.a, t.b);
}

TEST(Build, RandomLoopsOnACoarseGrid) {
  std::mt19937 random(17);
  int good = 0;
  for (int round = 0; round < 4000; ++round) {
    // Vertices are the points of a 5 by 5 grid, so that loops often touch at vertices; a few points have a second
    // vertex.
    FaceInput input;
    std::vector<Segment> segments;
    const int loops = 1 + static_cast<int>(random() % 2);
    for (int l = 0; l < loops; ++l) {
      ChainInput chain{l, {}, {}, false};
      const std::size_t count = 3 + random() % 4;
      for (std::size_t k = 0; k < count; ++k) {
        const auto i = static_cast<std::uint32_t>(random() % 5), j = static_cast<std::uint32_t>(random() % 5);
        chain.vertices.push_back(VertexId(i + 5 * j + (random() % 50 == 0 ? 100 : 0)));
        chain.q.push_back({0.25 * i - 0.5, 0.25 * j - 0.5});
      }
      chain.vertices.push_back(chain.vertices.front());
      chain.q.push_back(chain.q.front());
      for (std::size_t k = 0; k < count; ++k) {
        segments.push_back({chain.vertices[k], chain.vertices[k + 1], chain.q[k], chain.q[k + 1]});
      }
      input.loops.push_back({{chain}, false});
    }
    bool crossing = false;
    for (const Segment& s : segments) crossing = crossing || (s.a == s.b && s.va != s.vb);
    std::erase_if(segments, [](const Segment& s) { return s.a == s.b; });
    for (std::size_t i = 0; i < segments.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) crossing = crossing || in_conflict(segments[i], segments[j]);
    }
    FaceMesh mesh;
    const auto faults = mesh.build(input);
    const bool only_nesting = std::all_of(faults.begin(), faults.end(), [](const LoopFault& f) {
      return f.what == "inverted" || f.what == "not nested" || f.what == "no domain";
    });
    ASSERT_EQ(crossing, !only_nesting);
    if (crossing) continue;
    bool nested = true;
    double inside = 0;
    for (int i = -40; i < 40; ++i) {
      for (int j = -40; j < 40; ++j) {
        const Vec2 p{(i + 0.5) / 64 + 0x1p-20, (j + 0.5) / 64 + 0x1p-21};
        const int w = winding(input, p);
        nested = nested && (w == 0 || w == 1);
        inside += w == 1;
        if (faults.empty()) {
          ASSERT_EQ(w == 1, mesh.locate(p).has_value());
        }
      }
    }
    if (!nested) {
      EXPECT_FALSE(faults.empty());
    }
    if (!faults.empty()) continue;
    ++good;
    expect_valid(mesh);
    EXPECT_NEAR(area(mesh), inside / 4096, 0.03);
  }
  EXPECT_GT(good, 20);
}

TEST(Build, LongConstraintsThroughManyNodes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-0.49, 0.49);
  FaceInput input{{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0)}, {}};
  for (std::uint32_t k = 0; k < 3000; ++k) {
    input.isolated.push_back({VertexId(100 + k), testing::on_grid(Vec2{coordinate(random), coordinate(random)})});
  }
  for (std::uint32_t k = 0; k < 20; ++k) {
    const double y = -0.45 + 0.045 * k;
    input.loops.push_back(
        open_chain({{10 + 2 * k, {-0.48, y}}, {11 + 2 * k, {0.48, y + 0.03}}}, static_cast<std::int32_t>(1 + k)));
  }
  const FaceMesh mesh = built(input);
  EXPECT_NEAR(area(mesh), 1.0, 1e-12);
  for (std::int32_t use = 1; use <= 20; ++use) EXPECT_EQ(sides_of(mesh, use), 2U);
}

}  // namespace
}  // namespace curvetet
