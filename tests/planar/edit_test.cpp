// Insertion, splits, flips and removal: the mesh stays valid after each, and refusals agree with the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
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
using testing::on_grid;
using testing::open_chain;
using testing::rectangle;
using testing::reversed;

void expect_valid(const FaceMesh& mesh) {
  for (const std::string& what : mesh.check()) ADD_FAILURE() << what;
}

FaceMesh built(const FaceInput& input) {
  FaceMesh mesh;
  EXPECT_TRUE(mesh.build(input).empty());
  return mesh;
}

FaceMesh::FlipWanted delaunay(const FaceMesh& mesh) {
  return [&mesh](NodeId a, NodeId b, NodeId c, NodeId d) {
    return incircle(mesh.node(a).q, mesh.node(b).q, mesh.node(c).q, mesh.node(d).q) > 0;
  };
}

/// A criterion that is not transitive: by a hash of the four nodes.
bool arbitrary(NodeId a, NodeId b, NodeId c, NodeId d) {
  return (a.value() * 7 + b.value() * 13 + c.value() * 31 + d.value() * 57) % 3 == 0;
}

/// A plate with a round hole, a slit from the rim, a free inner chain with a kink, and a hole that touches the rim.
FaceInput plate() {
  FaceInput input;
  ChainInput rim{0, {}, {}, false}, in{1, {}, {}, false}, out{2, {}, {}, false};
  rim.vertices = {VertexId(0U), VertexId(1U), VertexId(2U), VertexId(3U), VertexId(0U)};
  rim.q = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}};
  in.vertices = {VertexId(0U), VertexId(5U), VertexId(6U)};
  in.q = {{-0.5, -0.5}, {-0.375, -0.25}, {-0.25, 0}};
  out.vertices = {in.vertices.rbegin(), in.vertices.rend()};
  out.q = {in.q.rbegin(), in.q.rend()};
  input.loops.push_back({{rim, in, out}, false});
  input.loops.push_back(closed_loop(reversed(circle({0.125, 0.125}, 0.15, 9)), 20, 3));
  input.loops.push_back(open_chain({{40, {-0.1, -0.4}}, {41, {0.1, -0.3}}, {42, {0.3, -0.4}}}, 4));
  LoopInput touching = closed_loop({{0.5, 0.5}, {0.4375, 0.375}, {0.375, 0.4375}}, 60, 5);
  touching.chains[0].vertices.front() = touching.chains[0].vertices.back() = VertexId(2U);
  input.loops.push_back(touching);
  input.isolated.push_back({VertexId(80U), {-0.25, 0.375}});
  return input;
}

std::vector<FaceEdge> constrained_edges(const FaceMesh& mesh) {
  std::vector<FaceEdge> edges;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& f = mesh.triangle(TriangleId(t));
    for (int i = 0; f.alive() && i < 3; ++i) {
      if (f.use[static_cast<std::size_t>(i)] != -1) edges.push_back({TriangleId(t), i});
    }
  }
  return edges;
}

std::array<NodeId, 2> ends(const FaceMesh& mesh, FaceEdge e) {
  const FaceTriangle& f = mesh.triangle(e.triangle);
  return {f.node[static_cast<std::size_t>((e.local + 1) % 3)], f.node[static_cast<std::size_t>((e.local + 2) % 3)]};
}

TEST(Insert, DelaunayByDefinition) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    FaceMesh mesh = built({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0)}, {}});
    const auto wanted = delaunay(mesh);
    std::mt19937 random(seed);
    // Coarse coordinates: many points on edges, many cocircular, some duplicates.
    std::uniform_int_distribution<int> coordinate(-7, 7);
    std::vector<TriangleId> changed;
    for (std::uint32_t k = 0; k < 120; ++k) {
      const Vec2 q{coordinate(random) / 16.0, coordinate(random) / 16.0};
      const auto at = mesh.locate(q);
      ASSERT_TRUE(at);
      const PlanarRefusal refusal = mesh.judge_insert(q, *at);
      const std::size_t before = mesh.node_count();
      const NodeId n = mesh.insert(VertexId(100 + k), q, *at, wanted, changed);
      ASSERT_EQ(n.valid(), refusal == PlanarRefusal::none);
      if (!n.valid()) {
        EXPECT_EQ(refusal, PlanarRefusal::duplicate);
        EXPECT_EQ(mesh.node_count(), before);
        continue;
      }
      expect_valid(mesh);
      std::vector<TriangleId> around;
      mesh.star(n, around);
      std::sort(around.begin(), around.end());
      std::sort(changed.begin(), changed.end());
      EXPECT_EQ(around, changed);
    }
    EXPECT_EQ(oracle::count_not_delaunay(mesh), 0U);
  }
}

TEST(Insert, RefusalsCarryTheirReason) {
  FaceMesh mesh = built({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0)}, {}});
  EXPECT_FALSE(mesh.locate({0.75, 0}));
  EXPECT_EQ(mesh.judge_insert({0.75, 0}, TriangleId(0U)), PlanarRefusal::outside);
  EXPECT_EQ(mesh.judge_insert({0.5, 0.25}, *mesh.locate({0.5, 0.25})), PlanarRefusal::on_constraint);
  EXPECT_EQ(mesh.judge_insert({0.5, 0.5}, *mesh.locate({0.5, 0.5})), PlanarRefusal::duplicate);
  EXPECT_EQ(mesh.judge_insert({0, 0}, TriangleId(99U)), PlanarRefusal::outside);
}

TEST(Insert, WalkStopsAtConstraints) {
  FaceMesh mesh = built(plate());
  const auto from = mesh.locate({-0.45, 0.45});
  ASSERT_TRUE(from);
  const FaceMesh::WalkEnd out = mesh.walk({-0.45, 0.75}, *from);
  ASSERT_TRUE(out.blocked);
  EXPECT_FALSE(out.triangle);
  const auto [a, b] = ends(mesh, *out.blocked);
  EXPECT_LT(orient2d(mesh.node(a).q, mesh.node(b).q, {-0.45, 0.75}), 0);
  EXPECT_NE(mesh.triangle(out.blocked->triangle).use[static_cast<std::size_t>(out.blocked->local)], -1);
  EXPECT_TRUE(mesh.walk({-0.4, 0.4}, *from).triangle);
}

TEST(Insert, LocateFindsEveryNodeAroundHoles) {
  FaceMesh mesh = built(plate());
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    for (std::size_t n = 0; n < mesh.node_count(); ++n) {
      const auto at = mesh.locate(mesh.node(NodeId(n)).q, TriangleId(t));
      ASSERT_TRUE(at);
      const auto& nodes = mesh.triangle(*at).node;
      EXPECT_NE(std::find(nodes.begin(), nodes.end(), NodeId(n)), nodes.end());
    }
  }
  EXPECT_FALSE(mesh.locate({0.125, 0.125}));  // in the hole
}

/// Random insertions and splits; `spread` scales how far from the chord the arcs pass.
void mutate(unsigned seed, double spread, bool with_delaunay) {
  FaceMesh mesh = built(plate());
  const FaceMesh::FlipWanted wanted = with_delaunay ? delaunay(mesh) : FaceMesh::FlipWanted(arbitrary);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<TriangleId> changed;
  std::size_t splits = 0, refused = 0;
  for (std::uint32_t k = 0; k < 120; ++k) {
    const VertexId vertex(1000 + k);
    if (k % 3 == 0) {
      const Vec2 q = on_grid(Vec2{unit(random) - 0.5, unit(random) - 0.5});
      const auto at = mesh.locate(q);
      if (at && mesh.judge_insert(q, *at) == PlanarRefusal::none) mesh.insert(vertex, q, *at, wanted, changed);
    } else {
      const auto edges = constrained_edges(mesh);
      const FaceEdge edge = edges[random() % edges.size()];
      const auto [a, b] = ends(mesh, edge);
      const Vec2 p = mesh.node(a).q, r = mesh.node(b).q, d = r - p;
      const double along = 0.2 + 0.6 * unit(random), height = spread * (2 * unit(random) - 1) * (random() % 4 != 0);
      const Vec2 q = on_grid(p + along * d + height * Vec2{-d.y, d.x});
      const FaceTriangle& f = mesh.triangle(edge.triangle);
      const bool boundary = !f.neighbour[static_cast<std::size_t>(edge.local)].valid();
      const PlanarRefusal refusal = mesh.judge_split(edge, q);
      EXPECT_EQ(refusal == PlanarRefusal::none, oracle::split_is_clear(mesh, edge, q));
      const double before = area(mesh);
      const double gain = boundary ? -0.5 * cross(d, q - p) : 0;
      const NodeId n = mesh.split(edge, vertex, q, wanted, changed);
      ASSERT_EQ(n.valid(), refusal == PlanarRefusal::none);
      EXPECT_NEAR(area(mesh), n.valid() ? before + gain : before, 1e-12);
      ++(n.valid() ? splits : refused);
      if (n.valid()) {
        EXPECT_TRUE(mesh.find_edge(a, n));
        EXPECT_TRUE(mesh.find_edge(n, b));
      }
    }
    expect_valid(mesh);
    if (::testing::Test::HasFailure()) return;
    if (with_delaunay) {
      ASSERT_EQ(oracle::count_not_locally_delaunay(mesh), 0U);
    }
  }
  EXPECT_GT(splits, 10U);
}

TEST(Split, ArcsNearTheChord) {
  for (unsigned seed = 1; seed <= 12; ++seed) mutate(seed, 0.1, true);
}
TEST(Split, ArcsFarFromTheChord) {
  for (unsigned seed = 1; seed <= 12; ++seed) mutate(seed, 1.0, true);
}
TEST(Split, AnyCriterion) {
  for (unsigned seed = 1; seed <= 12; ++seed) mutate(seed, 0.3, false);
}

TEST(Split, SlitKeepsTheUseOfEachSide) {
  for (const double height : {-0.05, 0.0, 0.05}) {
    FaceMesh mesh = built(plate());
    const NodeId a = mesh.nodes_of(VertexId(0U)).front(), b = mesh.nodes_of(VertexId(5U)).front();
    const auto edge = mesh.find_edge(a, b);
    ASSERT_TRUE(edge);
    const Vec2 q = on_grid(Vec2{-0.4375 - height, -0.375 + height / 2});
    std::vector<TriangleId> changed;
    const NodeId n = mesh.split(*edge, VertexId(90U), q, delaunay(mesh), changed);
    ASSERT_TRUE(n.valid());
    expect_valid(mesh);
    for (const auto& [u, v, use] : {std::tuple(a, n, 1), {n, b, 1}, {n, a, 2}, {b, n, 2}}) {
      const auto side = mesh.find_edge(u, v);
      ASSERT_TRUE(side);
      EXPECT_EQ(ends(mesh, *side)[0], u);
      EXPECT_EQ(mesh.triangle(side->triangle).use[static_cast<std::size_t>(side->local)], use);
    }
  }
}

TEST(Split, RefusesWhatIsNoSegment) {
  FaceMesh mesh = built({{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0)}, {}});
  std::vector<TriangleId> changed;
  const NodeId a = mesh.nodes_of(VertexId(0U)).front(), c = mesh.nodes_of(VertexId(2U)).front();
  const NodeId b = mesh.nodes_of(VertexId(1U)).front(), d = mesh.nodes_of(VertexId(3U)).front();
  const auto diagonal = mesh.find_edge(a, c) ? mesh.find_edge(a, c) : mesh.find_edge(b, d);
  ASSERT_TRUE(diagonal);
  EXPECT_EQ(mesh.judge_split(*diagonal, {0, 0}), PlanarRefusal::outside);
  EXPECT_EQ(mesh.judge_split({TriangleId(77U), 0}, {0, 0}), PlanarRefusal::outside);
  EXPECT_EQ(mesh.judge_split(*mesh.find_edge(a, b), {-0.5, -0.5}), PlanarRefusal::duplicate);
  EXPECT_EQ(mesh.judge_split(*mesh.find_edge(a, b), {0.5, 0.5}), PlanarRefusal::duplicate);
  EXPECT_EQ(mesh.judge_split(*mesh.find_edge(a, b), {0.75, -0.5}), PlanarRefusal::folded);
  EXPECT_EQ(mesh.judge_split(*mesh.find_edge(a, b), {0, 0.75}), PlanarRefusal::invariant);
  EXPECT_EQ(mesh.judge_split(*mesh.find_edge(a, b), {0, -5}), PlanarRefusal::outside);
  EXPECT_FALSE(mesh.split(*mesh.find_edge(a, b), VertexId(9U), {0, 0.75}, {}, changed).valid());
  expect_valid(mesh);
}

TEST(Flip, OnlyConvexFreeEdges) {
  FaceMesh mesh = built(plate());
  std::mt19937 random(3);
  for (int k = 0; k < 300; ++k) {
    const FaceEdge e{TriangleId(static_cast<std::uint32_t>(random() % mesh.triangle_slots())),
                     static_cast<int>(random() % 3)};
    mesh.flip(e);
    if (k % 10 == 0) expect_valid(mesh);
  }
  std::vector<TriangleId> all, changed;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) all.push_back(TriangleId(t));
  mesh.restore(all, delaunay(mesh), changed);
  expect_valid(mesh);
  EXPECT_EQ(oracle::count_not_locally_delaunay(mesh), 0U);
  mesh.restore(
      all, [](auto...) { return true; }, changed);  // would flip for ever
  expect_valid(mesh);
}

TEST(Remove, InteriorNodesOnly) {
  FaceMesh mesh = built(plate());
  const auto wanted = delaunay(mesh);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  std::vector<TriangleId> changed;
  const double before = area(mesh);
  std::vector<NodeId> inserted;
  for (std::uint32_t k = 0; k < 200; ++k) {
    const Vec2 q = on_grid(Vec2{unit(random), unit(random)});
    const auto at = mesh.locate(q);
    if (at && mesh.judge_insert(q, *at) == PlanarRefusal::none) {
      inserted.push_back(mesh.insert(VertexId(1000 + k), q, *at, wanted, changed));
    }
  }
  for (const auto v : {0U, 2U, 6U, 20U, 41U, 61U}) EXPECT_FALSE(mesh.remove_node(mesh.nodes_of(VertexId(v)).front()));
  std::shuffle(inserted.begin(), inserted.end(), random);
  for (const NodeId n : inserted) {
    ASSERT_TRUE(mesh.remove_node(n, wanted, changed));
    EXPECT_FALSE(mesh.remove_node(n));
    EXPECT_TRUE(mesh.nodes_of(mesh.node(n).vertex).empty());
    expect_valid(mesh);
    ASSERT_EQ(oracle::count_not_locally_delaunay(mesh), 0U);
  }
  EXPECT_NEAR(area(mesh), before, 1e-12);
}

TEST(Move, OnlyWithinWhatSeesTheWholeLink) {
  FaceMesh mesh = built(plate());
  std::vector<TriangleId> changed, around;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.45, 0.45);
  std::vector<NodeId> inserted;
  for (std::uint32_t k = 0; k < 60; ++k) {
    const Vec2 q = on_grid({coordinate(random), coordinate(random)});
    const auto holder = mesh.locate(q);
    if (!holder) continue;
    const NodeId n = mesh.insert(VertexId(500 + k), q, *holder, {}, changed);
    if (n.valid()) inserted.push_back(n);
  }
  ASSERT_GT(inserted.size(), 20U);
  std::size_t moved = 0, refused = 0;
  for (int step = 0; step < 2000; ++step) {
    const NodeId n = inserted[static_cast<std::size_t>(step) % inserted.size()];
    const Vec2 before = mesh.node(n).q, reach{0.2 * coordinate(random), 0.2 * coordinate(random)};
    const Vec2 q = on_grid({before.x + reach.x, before.y + reach.y});
    mesh.star(n, around);
    const bool sees_all = std::all_of(around.begin(), around.end(), [&](TriangleId t) {
      const auto& nodes = mesh.triangle(t).node;
      const auto at = [&](std::size_t i) { return nodes[i] == n ? q : mesh.node(nodes[i]).q; };
      return orient2d(at(0), at(1), at(2)) > 0;
    });
    EXPECT_EQ(mesh.move_node(n, q), sees_all);
    EXPECT_EQ(mesh.node(n).q, sees_all ? q : before);
    ++(sees_all ? moved : refused);
  }
  EXPECT_GT(std::min(moved, refused), 100U);
  expect_valid(mesh);
  EXPECT_FALSE(mesh.move_node(NodeId(0U), mesh.node(NodeId(0U)).q)) << "a node of the boundary";
  EXPECT_FALSE(mesh.move_node(NodeId(123456U), {}));
}

TEST(Replace, AcceptsOnlyTheSameDomain) {
  FaceMesh mesh = built(plate());
  const std::size_t count = mesh.triangle_count();
  std::vector<std::array<NodeId, 3>> triangles;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) triangles.push_back(mesh.triangle(TriangleId(t)).node);
  FaceMesh other = mesh;
  std::mt19937 random(3);
  for (int k = 0; k < 100; ++k) {
    other.flip({TriangleId(static_cast<std::uint32_t>(random() % count)), static_cast<int>(random() % 3)});
  }
  EXPECT_TRUE(other.replace(triangles));
  expect_valid(other);
  for (std::size_t t = 0; t < count; ++t)
    EXPECT_EQ(other.triangle(TriangleId(t)).use, mesh.triangle(TriangleId(t)).use);
  auto broken = triangles;
  broken.pop_back();
  EXPECT_FALSE(other.replace(broken));
  broken = triangles;
  std::swap(broken[0][0], broken[0][1]);
  EXPECT_FALSE(other.replace(broken));
  broken = triangles;
  broken.push_back(triangles[0]);
  EXPECT_FALSE(other.replace(broken));
  broken = triangles;
  broken[0][0] = NodeId(12345U);
  EXPECT_FALSE(other.replace(broken));
  expect_valid(other);
}

TEST(Rename, NodesAreFoundByTheNewIds) {
  FaceMesh mesh = built(plate());
  mesh.rename([](VertexId v) { return VertexId(v.value() * 3 + 500); });
  expect_valid(mesh);
  EXPECT_TRUE(mesh.nodes_of(VertexId(2U)).empty());
  EXPECT_EQ(mesh.nodes_of(VertexId(506U)).size(), 1U);
}

TEST(Rebuild, KeepsInteriorNodesThatStayInside) {
  FaceMesh mesh = built(plate());
  std::vector<TriangleId> changed;
  const Vec2 in_hole_later{0.4, -0.1}, inside{-0.4, 0.2};
  mesh.insert(VertexId(200U), on_grid(in_hole_later), *mesh.locate(in_hole_later), {}, changed);
  mesh.insert(VertexId(201U), on_grid(inside), *mesh.locate(inside), {}, changed);
  FaceInput input = plate();
  input.loops.push_back(closed_loop(reversed(circle({0.4, -0.1}, 0.05, 6)), 300, 9));
  std::vector<VertexId> dropped;
  ASSERT_TRUE(mesh.rebuild(input, dropped).empty());
  expect_valid(mesh);
  EXPECT_EQ(dropped, std::vector<VertexId>{VertexId(200U)});
  EXPECT_EQ(mesh.nodes_of(VertexId(201U)).size(), 1U);
  const std::size_t before = mesh.triangle_count();
  input.loops.push_back(closed_loop(reversed(circle({0.4, -0.1}, 0.06, 6)), 400, 10));
  EXPECT_FALSE(mesh.rebuild(input, dropped).empty());
  EXPECT_EQ(mesh.triangle_count(), before);
  expect_valid(mesh);
}

/// Features of a few grid steps within a domain of size one.
TEST(Insert, TinyFeatures) {
  const double g = 0x1p-42;
  FaceInput input{{closed_loop(rectangle(-0.5, -0.5, 0.5, 0.5), 0)}, {}};
  input.loops.push_back(closed_loop(reversed(rectangle(0.5 - 3 * g, -0.25, 0.5 - g, 0.25)), 10, 1));  // nearly tangent
  input.loops.push_back(closed_loop(reversed(rectangle(0, 0, g, g)), 20, 2));
  input.loops.push_back(open_chain({{30, {-4 * g, 0}}, {31, {-2 * g, g}}, {32, {-0.4, 0.3}}}, 3));
  FaceMesh mesh = built(input);
  expect_valid(mesh);
  const auto wanted = delaunay(mesh);
  std::mt19937 random(5);
  std::vector<TriangleId> changed;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const double scale = std::ldexp(g, static_cast<int>(random() % 42));
    const auto draw = [&] { return on_grid(scale * (static_cast<double>(random() % 2001) / 1000 - 1)); };
    const double x = draw();
    const Vec2 q{x, draw()};
    const auto at = mesh.locate(q);
    if (at && mesh.judge_insert(q, *at) == PlanarRefusal::none)
      mesh.insert(VertexId(1000 + k), q, *at, wanted, changed);
    const auto edges = constrained_edges(mesh);
    const FaceEdge edge = edges[random() % edges.size()];
    const auto [a, b] = ends(mesh, edge);
    const Vec2 m =
        on_grid(0.5 * (mesh.node(a).q + mesh.node(b).q)) + g * Vec2{static_cast<double>(random() % 3) - 1, 0};
    const bool clear = oracle::split_is_clear(mesh, edge, m);
    EXPECT_EQ(mesh.split(edge, VertexId(2000 + k), m, wanted, changed).valid(), clear);
    if (k % 10 == 0) expect_valid(mesh);
    ASSERT_FALSE(HasFailure());
  }
  expect_valid(mesh);
  EXPECT_EQ(oracle::count_not_locally_delaunay(mesh), 0U);
}

TEST(Determinism, SameOperationsSameMesh) {
  const auto run = [] {
    FaceMesh mesh = built(plate());
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    std::vector<TriangleId> changed;
    for (std::uint32_t k = 0; k < 500; ++k) {
      const Vec2 q = on_grid(Vec2{unit(random), unit(random)});
      const auto at = mesh.locate(q);
      if (at) mesh.insert(VertexId(1000 + k), q, *at, delaunay(mesh), changed);
    }
    std::vector<std::array<std::uint32_t, 3>> out;
    for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
      const auto& n = mesh.triangle(TriangleId(t)).node;
      out.push_back({n[0].value(), n[1].value(), n[2].value()});
    }
    return out;
  };
  EXPECT_EQ(run(), run());
}

/// A chart whose lower border is one point in space, vertex 0, in so many pieces; further nodes by vertex and place.
FaceInput chart_with_pole(int pieces, const std::vector<std::pair<std::uint32_t, Vec2>>& nodes) {
  ChainInput pole{0, {}, {}, false};
  for (int k = 0; k <= pieces; ++k) {
    pole.vertices.emplace_back(0U);
    pole.q.push_back(on_grid(Vec2{-0.5 + static_cast<double>(k) / pieces, -0.5}));
  }
  ChainInput rest{1, {VertexId(0U), VertexId(1U), VertexId(2U), VertexId(0U)}, {}, false};
  rest.q = {{0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}};
  FaceInput input;
  input.loops.push_back({{pole, rest}, false});
  for (const auto& [v, q] : nodes) input.isolated.push_back({VertexId(v), q});
  return input;
}

struct PoleFlips {
  FaceMesh mesh;
  std::vector<TriangleId> changed;

  NodeId node(std::uint32_t v) const { return mesh.nodes_of(VertexId(v)).front(); }
  bool is_pole(NodeId n) const { return mesh.node(n).vertex == VertexId(0U); }
  std::size_t edges_to_pole(NodeId n) const {
    const auto poles = mesh.nodes_of(VertexId(0U));
    return static_cast<std::size_t>(
        std::count_if(poles.begin(), poles.end(), [&](NodeId p) { return mesh.find_edge(n, p).has_value(); }));
  }
  void restore(const FaceMesh::FlipWanted& wanted) {
    std::vector<TriangleId> all;
    for (std::size_t t = 0; t < mesh.triangle_slots(); ++t)
      if (mesh.triangle(TriangleId(t)).alive()) all.push_back(TriangleId(t));
    mesh.restore(all, wanted, changed);
  }
};

class PlanarPole : public ::testing::TestWithParam<int> {};

// However many edges of the chart it is: node 10 leaves the nodes around the pole and comes back.
TEST_P(PlanarPole, AnEdgeToAPoleIsFlippedAsTheOneEdgeItIsInSpace) {
  PoleFlips at{
      built(chart_with_pole(GetParam(), {{10, {0, -0.046875}}, {11, {-0.3125, -0.109375}}, {12, {0.3125, -0.109375}}})),
      {}};
  const NodeId apex = at.node(10), right = at.node(11), left = at.node(12);
  const std::size_t triangles = at.mesh.triangle_count();
  ASSERT_GT(at.edges_to_pole(apex), 0u);
  at.restore([&](NodeId a, NodeId b, NodeId c, NodeId d) {
    const bool to_pole = (a == apex && at.is_pole(b)) || (b == apex && at.is_pole(a));
    return to_pole && !at.is_pole(c) && !at.is_pole(d);
  });
  expect_valid(at.mesh);
  EXPECT_TRUE(at.mesh.find_edge(right, left));
  EXPECT_EQ(at.edges_to_pole(apex), 0u);
  EXPECT_FALSE(at.changed.empty());
  at.restore([&](NodeId a, NodeId b, NodeId c, NodeId d) {
    const bool around = (a == right && b == left) || (a == left && b == right);
    return around && (at.is_pole(c) || at.is_pole(d));
  });
  expect_valid(at.mesh);
  EXPECT_FALSE(at.mesh.find_edge(right, left));
  EXPECT_GT(at.edges_to_pole(apex), 0u);
  EXPECT_EQ(at.mesh.triangle_count(), triangles);
}

INSTANTIATE_TEST_SUITE_P(Pieces, PlanarPole, ::testing::Values(1, 2, 3, 8));

// A criterion that says yes or no at random ends, and leaves a valid mesh.
TEST(PlanarEdit, FlipsAtAPoleKeepTheMeshValid) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-0.4375, 0.4375);
  std::vector<std::pair<std::uint32_t, Vec2>> nodes;
  for (std::uint32_t k = 0; k < 40; ++k) nodes.emplace_back(10 + k, on_grid(Vec2{unit(random), unit(random)}));
  PoleFlips at{built(chart_with_pole(9, nodes)), {}};
  const std::size_t triangles = at.mesh.triangle_count();
  for (int round = 0; round < 20; ++round) {
    at.restore([&](NodeId, NodeId, NodeId, NodeId) { return random() % 3 == 0; });
    expect_valid(at.mesh);
    EXPECT_EQ(at.mesh.triangle_count(), triangles);
  }
}

}  // namespace
}  // namespace curvetet
