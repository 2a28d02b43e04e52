// What hangs together around the vertices of a face: against a naive twin, and on sets of triangles made by hand.
#include "boundary/vertex_fans.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "boundary/face_recovery.h"
#include "oracle/naive_fans.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet {

void PrintTo(const Fans& fans, std::ostream* out) { *out << fans.closed << " closed, " << fans.open << " open"; }

namespace {

using namespace test;
using Facets = std::vector<FacetKey>;

std::set<VertexId> vertices_of(const FaceMesh& mesh) {
  std::set<VertexId> vertices;
  for (std::size_t n = 0; n < mesh.node_count(); ++n)
    if (mesh.triangle_at(NodeId(n)).valid()) vertices.insert(mesh.node(NodeId(n)).vertex);
  return vertices;
}

/// Loses some facets, and puts one vertex in the place of another in some.
Facets spoiled(Facets facets, std::mt19937& random) {
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t from = facets[random() % facets.size()][0], to = facets[random() % facets.size()][0];
    if (k == 0) facets.erase(facets.begin() + static_cast<std::ptrdiff_t>(random() % facets.size()));
    for (FacetKey& f : facets)
      if (std::find(f.begin(), f.end(), to) == f.end()) std::replace(f.begin(), f.end(), from, to);
  }
  return facets;
}

void expect_as_naive(const Model& model, const BoundaryMesh& boundary, FaceId face, const Facets& facets) {
  std::map<VertexId, FanFault> faults;
  for (const FanFault& f : find_fan_faults(boundary.faces[face], facets)) faults[f.vertex] = f;
  for (const VertexId v : vertices_of(boundary.faces[face])) {
    const Fans found = oracle::naive_found_fans(facets, v),
               expected = oracle::naive_expected_fans(model, boundary, face, v);
    EXPECT_EQ(faults.contains(v), found != expected) << "face " << face.value() << ", vertex " << v.value();
    if (!faults.contains(v)) continue;
    EXPECT_EQ(faults[v].found, found);
    EXPECT_EQ(faults[v].expected, expected);
  }
}

TEST(VertexFans, OfFacesOfBodiesAreAsTheLoopsSay) {
  std::mt19937 random(1);
  std::size_t spoils_seen = 0;
  for (const Model& model :
       {make_box(2, 3, 4), make_ball(3), make_shell(10, 9), make_cylinder(2, 5), make_cone(2, 0, 4), make_torus(5, 1),
        make_tube(10, 9.5, 30), make_lens(5, 2), make_half_ellipsoid(1, 3)}) {
    for (const double share : {1.0, 0.2}) {
      BoundaryRunOptions options{share * model.frame.length_to_cad(model.diagonal()), 0};
      options.until = Until::faces;
      const auto run = run_boundary(model, options);
      ASSERT_FALSE(HasFailure());
      for (std::size_t f = 0; f < model.faces.size(); ++f) {
        const FaceId face(f);
        const Facets facets = facets_of(run->boundary.faces[face], face);
        EXPECT_TRUE(find_fan_faults(run->boundary.faces[face], facets).empty());
        expect_as_naive(model, run->boundary, face, facets);
        expect_as_naive(model, run->boundary, face, {});
        const Facets other = spoiled(facets, random);
        expect_as_naive(model, run->boundary, face, other);
        spoils_seen += find_fan_faults(run->boundary.faces[face], other).empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GT(spoils_seen, 0U) << "or the test says nothing";
}

constexpr double kHalf = 0.5;

/// A square 0 1 2 3 with further loops, and inner vertices.
FaceMesh square(std::vector<LoopInput> more, const std::vector<Vec2>& inner) {
  FaceInput input;
  input.loops.push_back({{{0, {VertexId(0U), VertexId(1U)}, {{-kHalf, -kHalf}, {kHalf, -kHalf}}},
                          {1, {VertexId(1U), VertexId(2U)}, {{kHalf, -kHalf}, {kHalf, kHalf}}},
                          {2, {VertexId(2U), VertexId(3U)}, {{kHalf, kHalf}, {-kHalf, kHalf}}},
                          {3, {VertexId(3U), VertexId(0U)}, {{-kHalf, kHalf}, {-kHalf, -kHalf}}}}});
  for (LoopInput& loop : more) input.loops.push_back(std::move(loop));
  for (std::size_t i = 0; i < inner.size(); ++i) input.isolated.push_back({VertexId(4 + i), inner[i]});
  FaceMesh mesh;
  EXPECT_TRUE(mesh.build(input).empty());
  return mesh;
}

std::map<VertexId, Fans> expected_of(const FaceMesh& mesh) {
  std::map<VertexId, Fans> expected;
  for (const FanFault& f : find_fan_faults(mesh, {})) expected[f.vertex] = f.expected;
  return expected;
}

/// How often each edge is there.
std::multiset<int> edge_counts(const Facets& facets) {
  std::map<std::uint64_t, int> count;
  for (const FacetKey& f : facets)
    for (std::size_t k = 0; k < 3; ++k) ++count[edge_key(VertexId(f[k]), VertexId(f[(k + 1) % 3]))];
  std::multiset<int> counts;
  for (const auto& [edge, n] : count) counts.insert(n);
  return counts;
}

// Four triangles around an inner vertex, and a sheet of four that touches them in one vertex: all vertices are used,
// all edges have their two triangles, those of the square one.
TEST(VertexFans, TellTwoSheetsThatTouchInAVertex) {
  const FaceMesh mesh = square({}, {{0, 0}, {0.125, 0.25}, {-0.25, 0.125}, {-0.125, -0.25}});
  const Facets fan{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 3, 4}};
  for (const std::uint32_t touched : {4U, 0U}) {
    Facets facets = fan;
    const std::uint32_t apex = touched == 4 ? 4 : 0;
    for (const FacetKey& f : {FacetKey{apex, 5, 6}, {apex, 6, 7}, {apex, 5, 7}, {5, 6, 7}}) facets.push_back(f);
    const std::multiset<int> counts = edge_counts(facets);
    EXPECT_EQ(counts.count(1), 4U);
    EXPECT_EQ(counts.count(2), counts.size() - 4);
    const std::vector<FanFault> faults = find_fan_faults(mesh, facets);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].vertex, VertexId(touched));
    EXPECT_EQ(faults[0].expected, (touched == 4 ? Fans{1, 0} : Fans{0, 1}));
    EXPECT_EQ(faults[0].found, (touched == 4 ? Fans{2, 0} : Fans{1, 1}));
  }
}

TEST(VertexFans, TellVerticesThatAreNotUsedAndThoseOfOtherFaces) {
  const FaceMesh mesh = square({}, {{0, 0}});
  EXPECT_TRUE(find_fan_faults(mesh, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 3, 4}}).empty());
  const std::vector<FanFault> faults = find_fan_faults(mesh, {{0, 1, 9}, {1, 2, 9}, {2, 3, 9}, {0, 3, 9}});
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].vertex, VertexId(4U));
  EXPECT_EQ(faults[0].found, (Fans{0, 0}));
  EXPECT_EQ(faults[1].vertex, VertexId(9U));
  EXPECT_EQ(faults[1].expected, (Fans{0, 0}));
}

TEST(VertexFans, JoinTheSidesOfASlitAndKeepCornersApartWhereLoopsTouch) {
  const VertexId corner(0U), inside(4U), next(5U);
  const std::vector<Vec2> q{{-kHalf, -kHalf}, {-0.125, 0.125}, {0.125, -0.125}};
  const FaceMesh slit = square({{{{4, {corner, inside}, {q[0], q[1]}, true}}, true}}, {});
  const auto at_slit = expected_of(slit);
  EXPECT_EQ(at_slit.at(inside), (Fans{1, 0}));
  EXPECT_EQ(at_slit.at(corner), (Fans{0, 1}));
  const FaceMesh touching = square(
      {{{{4, {corner, inside}, {q[0], q[1]}}, {5, {inside, next}, {q[1], q[2]}}, {6, {next, corner}, {q[2], q[0]}}}}},
      {});
  const auto at_hole = expected_of(touching);
  EXPECT_EQ(at_hole.at(corner), (Fans{0, 2}));
  EXPECT_EQ(at_hole.at(inside), (Fans{0, 1}));
}

}  // namespace
}  // namespace curvetet
