// The march of the second stage: whatever it returns keeps the paper's requirements I to VI, and with them conditions 1
// to 4 of each step; and it takes nothing that is locked for another face.
#include "boundary/march.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "predicates/predicates.h"
#include "quality/measures.h"
#include "spatial/flips.h"
#include "support/bodies.h"
#include "support/run_boundary.h"

namespace curvetet::test {
namespace {

std::unique_ptr<BoundaryRun> tetrahedralized(const Model& model, double size) {
  BoundaryRunOptions options{size, 12};
  options.until = Until::tets;
  return run_boundary(model, options);
}

using NodePair = std::pair<NodeId, NodeId>;
NodePair ordered(NodeId a, NodeId b) { return a < b ? NodePair{a, b} : NodePair{b, a}; }

/// Edges of t_ps with one triangle: the external ones.
std::set<NodePair> external_edges(const FaceMesh& mesh) {
  std::set<NodePair> external;
  for (std::size_t i = 0; i < mesh.triangle_slots(); ++i) {
    const FaceTriangle& t = mesh.triangle(TriangleId(i));
    for (std::size_t k = 0; t.alive() && k < 3; ++k)
      if (!t.neighbour[k].valid()) external.insert(ordered(t.node[(k + 1) % 3], t.node[(k + 2) % 3]));
  }
  return external;
}

double chart_area(const FaceMesh& mesh, const NodeTriple& n) {
  const Vec2 a = mesh.node(n[0]).q;
  return 0.5 * cross(mesh.node(n[1]).q - a, mesh.node(n[2]).q - a);
}

std::vector<NodeTriple> triangles_of(const FaceMesh& mesh) {
  std::vector<NodeTriple> triangles;
  for (std::size_t i = 0; i < mesh.triangle_slots(); ++i)
    if (mesh.triangle(TriangleId(i)).alive()) triangles.push_back(mesh.triangle(TriangleId(i)).node);
  return triangles;
}

void expect_facets_on_the_face(const BoundaryRun& run, FaceId face, const std::vector<NodeTriple>& triangles) {
  const FaceMesh& mesh = run.boundary.faces[face];
  for (const NodeTriple& n : triangles) {
    const VertexId a = mesh.node(n[0]).vertex, b = mesh.node(n[1]).vertex, c = mesh.node(n[2]).vertex;
    for (VertexId v : {a, b, c}) {
      const auto& faces = run.conjoint->faces_of(v);
      EXPECT_NE(std::find(faces.begin(), faces.end(), face), faces.end()) << "I, condition 1";
    }
    const bool collapsed = a == b || b == c || c == a;  // at a pole
    EXPECT_TRUE(collapsed || run.tets->find_facet(a, b, c)) << "III: facets of a complex do not cross";
    EXPECT_GT(orient2d(mesh.node(n[0]).q, mesh.node(n[1]).q, mesh.node(n[2]).q), 0) << "condition 4";
  }
}

void expect_whole(const FaceMesh& mesh, const std::vector<NodeTriple>& triangles) {
  std::map<NodePair, int> count;
  std::set<NodePair> directed;
  std::map<NodeId, std::size_t> at_node;
  double area = 0, area_of_t_ps = 0;
  for (const NodeTriple& n : triangles) {
    area += chart_area(mesh, n);
    for (std::size_t k = 0; k < 3; ++k) {
      ++count[ordered(n[k], n[(k + 1) % 3])];
      ++at_node[n[k]];
      EXPECT_TRUE(directed.insert({n[k], n[(k + 1) % 3]}).second) << "apexes on one side of an edge: condition 4";
    }
  }
  const std::set<NodePair> external = external_edges(mesh);
  std::map<NodeId, std::size_t> edges_at_node, external_at_node;
  for (const auto& [edge, n] : count) {
    EXPECT_EQ(n, external.contains(edge) ? 1 : 2) << "IV, V, condition 3";
    for (NodeId end : {edge.first, edge.second}) {
      ++edges_at_node[end];
      external_at_node[end] += external.contains(edge) ? 1 : 0;
    }
  }
  for (const auto& [node, n] : at_node)
    EXPECT_EQ(2 * n, 2 * edges_at_node[node] - external_at_node[node]) << "VI, condition 2";
  for (const NodeTriple& n : triangles_of(mesh)) {
    area_of_t_ps += chart_area(mesh, n);
    for (NodeId node : n) EXPECT_TRUE(at_node.contains(node)) << "II";
  }
  EXPECT_NEAR(area, area_of_t_ps, 1e-9 * area_of_t_ps) << "III";
}

std::vector<std::pair<Model, double>> bodies() {
  return {{make_cylinder(2, 5), 0.8}, {make_cylinder(2, 5), 0.35}, {make_cone(2, 0, 4), 0.5}, {make_cone(2, 1, 4), 0.4},
          {make_torus(5, 1), 0.7},    {make_lens(5, 2), 0.6},      {make_tube(10, 9, 30), 3}};
}

TEST(March, KeepsRequirementsAndConditions) {
  std::size_t completed = 0;
  for (const auto& [model, size] : {std::pair{make_cylinder(2, 5), 0.8},
                                    {make_cylinder(2, 5), 0.35},
                                    {make_cone(2, 0, 4), 0.5},
                                    {make_cone(2, 1, 4), 0.4},
                                    {make_torus(5, 1), 0.7},
                                    {make_lens(5, 2), 0.6},
                                    {make_tube(10, 9, 30), 3.0}}) {
    const auto run = tetrahedralized(model, size);
    ASSERT_FALSE(HasFailure());
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      const MarchResult m = march_face(*run->conjoint, FaceId(f));
      EXPECT_EQ(m.seeds + m.missing.size(), m.total);
      if (m.missing.empty()) continue;
      if (!m.complete) {
        EXPECT_EQ(m.triangles.size(), triangles_of(run->boundary.faces[FaceId(f)]).size());
        continue;
      }
      ++completed;
      expect_facets_on_the_face(*run, FaceId(f), m.triangles);
      expect_whole(run->boundary.faces[FaceId(f)], m.triangles);
    }
  }
  EXPECT_GT(completed, 0u) << "or the test says nothing";
}

/// A facet of T_Γ that t_ps does not have.
std::optional<NodeTriple> brought_in(const FaceMesh& mesh, const MarchResult& march) {
  std::set<std::array<NodeId, 3>> of_t_ps;
  const auto sorted = [](NodeTriple n) {
    std::sort(n.begin(), n.end());
    return n;
  };
  for (const NodeTriple& n : triangles_of(mesh)) of_t_ps.insert(sorted(n));
  for (const NodeTriple& n : march.triangles)
    if (!of_t_ps.contains(sorted(n))) return n;
  return std::nullopt;
}

TEST(March, TakesNothingThatIsLockedForAnotherFace) {
  std::size_t tried = 0;
  for (const auto& [model, size] : bodies()) {
    const auto run = tetrahedralized(model, size);
    ASSERT_FALSE(HasFailure());
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      const FaceMesh& mesh = run->boundary.faces[FaceId(f)];
      const auto taken = brought_in(mesh, march_face(*run->conjoint, FaceId(f)));
      if (!taken) continue;
      const auto vertex = [&](std::size_t k) { return mesh.node((*taken)[k]).vertex; };
      const auto facet = run->tets->find_facet(vertex(0), vertex(1), vertex(2));
      ASSERT_TRUE(facet.has_value());
      run->tets->lock(*facet, FaceId(f + 1));
      for (const NodeTriple& n : march_face(*run->conjoint, FaceId(f)).triangles)
        EXPECT_NE(facet_key(mesh.node(n[0]).vertex, mesh.node(n[1]).vertex, mesh.node(n[2]).vertex),
                  facet_key(vertex(0), vertex(1), vertex(2)));
      run->tets->complex().unlock(*facet);
      ++tried;
    }
  }
  EXPECT_GT(tried, 0u) << "or the test says nothing";
}

double least_sine(const BoundaryRun& run, const FaceMesh& mesh, const NodeTriple& n) {
  const auto at = [&](std::size_t k) { return run.vertices.position(mesh.node(n[k]).vertex); };
  return triangle_least_sine(at(0), at(1), at(2));
}

// Three neighbours on a finely divided circle are a flat ear of the disk, which flips in space may have made a facet.
TEST(March, TakesNoFlatEarWhereThereWasNone) {
  const Model model = make_tube(2, 1.95, 0.05);
  const auto run = tetrahedralized(model, 0.015);
  ASSERT_FALSE(HasFailure());
  for (int k = 0; k < 8; ++k)  // room around the hull, so that its edges can be flipped
    run->tets->insert(run->vertices.add({k & 1 ? 0.875 : -0.875, k & 2 ? 0.875 : -0.875, k & 4 ? 0.875 : -0.875},
                                        Owner::of(SolidId(0)), {}, Origin::interior));
  std::size_t ears = 0;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceMesh& mesh = run->boundary.faces[FaceId(f)];
    for (const CurveMesh& curve : run->boundary.curves) {
      for (std::size_t i = 0; i + 2 < curve.vertices.size() && ears < 10; i += 2) {
        const VertexId a = curve.vertices[i], b = curve.vertices[i + 1], c = curve.vertices[i + 2];
        if (mesh.nodes_of(a).size() != 1 || mesh.nodes_of(b).size() != 1 || mesh.nodes_of(c).size() != 1) continue;
        if (!recover_edge_by_flips(*run->tets, a, c) || !recover_facet_by_flips(*run->tets, a, b, c)) continue;
        ears += march_face(*run->conjoint, FaceId(f)).missing.empty() ? 0 : 1;
      }
    }
    for (const NodeTriple& n : march_face(*run->conjoint, FaceId(f)).triangles)
      EXPECT_GT(least_sine(*run, mesh, n), 0.0087);
  }
  EXPECT_GT(ears, 0u) << "or the test says nothing";
}

}  // namespace
}  // namespace curvetet::test
