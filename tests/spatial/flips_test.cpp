#include "spatial/flips.h"

#include <gtest/gtest.h>

#include <set>

#include "spatial/flips_support.h"

namespace curvetet::test {
namespace {

double shape(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double sum = norm2(u) + norm2(v) + norm2(w) + norm2(c - b) + norm2(d - b) + norm2(d - c);
  return dot(cross(u, v), w) / std::pow(sum, 1.5);
}

/// Locks every unlocked facet between two finite tets with a chance of one in `one_in`.
void lock_some(Tetrahedralization& mesh, std::uint64_t seed, int one_in) {
  std::mt19937_64 random(seed);
  const TetComplex& complex = mesh.complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    if (!complex.is_alive(TetId(k)) || complex.is_ghost(TetId(k))) continue;
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{TetId(k), i};
      if (random() % static_cast<std::uint64_t>(one_in) == 0 && !complex.is_locked(f))
        mesh.lock(f, FaceId(random() % 5));
    }
  }
}

std::vector<std::array<VertexId, 2>> all_edges(const TetComplex& complex) {
  std::set<std::array<VertexId, 2>> edges;
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    for (const auto& [i, j] : kEdge) {
      edges.insert(
          {std::min(complex.vertex(t, i), complex.vertex(t, j)), std::max(complex.vertex(t, i), complex.vertex(t, j))});
    }
  }
  return {edges.begin(), edges.end()};
}

TEST(Flips, TwoThreeAndBack) {
  VertexStore store;
  for (Vec3 p :
       {Vec3{0, 0, 0}, Vec3{0.25, 0, 0}, Vec3{0, 0.25, 0}, Vec3{0.0625, 0.0625, 0.125}, Vec3{0.0625, 0.0625, -0.125}}) {
    store.add(p, Owner{}, {}, Origin::interior);
  }
  Cloud cloud(store);
  Tetrahedralization& mesh = cloud.mesh;
  for (int turn = 0; turn < 3; ++turn) {
    if (const auto facet = mesh.find_facet(VertexId(0), VertexId(1), VertexId(2))) {
      ASSERT_TRUE(flip23(mesh, *facet));
      EXPECT_TRUE(mesh.find_edge(VertexId(3), VertexId(4)));
    } else {
      const auto edge = mesh.find_edge(VertexId(3), VertexId(4));
      ASSERT_TRUE(edge);
      mesh.keep_segment(VertexId(3), VertexId(4));
      EXPECT_FALSE(flip32(mesh, *edge));
      mesh.release_segment(VertexId(3), VertexId(4));
      ASSERT_TRUE(flip32(mesh, *edge));
      EXPECT_FALSE(mesh.find_edge(VertexId(3), VertexId(4)));
    }
    EXPECT_EQ(defects(mesh), "");
  }
}

TEST(Flips, RandomFlipsKeepValidityLocksAndVolume) {
  for (std::uint64_t seed : {1, 2, 3}) {
    Cloud cloud(random_points(150, seed, seed == 3 ? 8 : 0));
    Tetrahedralization& mesh = cloud.mesh;
    const double volume = sixfold_volume(mesh);
    lock_some(mesh, seed, 40);
    const auto locked = locked_facets(mesh.complex());
    std::mt19937_64 random(seed);
    std::size_t changed = 0;
    for (int step = 0; step < 3000; ++step) {
      const TetId t(random() % mesh.complex().slots());
      const int i = static_cast<int>(random() % 4), j = (i + 1 + static_cast<int>(random() % 3)) % 4;
      if (!mesh.complex().is_alive(t) || mesh.complex().is_ghost(t)) continue;
      switch (random() % 4) {
        case 0:
          changed += flip23(mesh, {t, i});
          break;
        case 1:
          changed += flip32(mesh, {t, i, j});
          break;
        case 2:
          changed += remove_edge(mesh, {t, i, j}, shape, 0).has_value();
          break;
        default:
          changed += remove_faces(mesh, {t, i}, shape, 0).has_value();
      }
      if (step % 100 == 0) {
        ASSERT_EQ(defects(mesh), "");
      }
    }
    EXPECT_GT(changed, 100U);
    EXPECT_EQ(defects(mesh), "");
    EXPECT_EQ(locked_facets(mesh.complex()), locked);
    EXPECT_NEAR(sixfold_volume(mesh), volume, 1e-12);
  }
}

TEST(Flips, RemovalPromisesTheLeastNewQuality) {
  Cloud cloud(random_points(200, 11));
  Tetrahedralization& mesh = cloud.mesh;
  std::size_t edges = 0, sheets = 0;
  for (std::size_t k = 0; k < mesh.complex().slots(); ++k) {
    for (int i = 0; i < 4; ++i) {
      const TetId t(k);
      if (!mesh.complex().is_alive(t) || mesh.complex().is_ghost(t)) continue;
      const auto v = mesh.complex().vertices(t);
      const double now = shape(mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2]), mesh.position(v[3]));
      const auto better = i < 2 ? remove_edge(mesh, {t, i, i + 1}, shape, now) : remove_faces(mesh, {t, i}, shape, now);
      if (better) {
        EXPECT_GT(*better, now);
      }
      if (better) ++(i < 2 ? edges : sheets);
    }
  }
  EXPECT_GT(edges, 0U);
  EXPECT_GT(sheets, 0U);
  EXPECT_EQ(defects(mesh), "");
}

/// Recovers random missing edges and keeps those that were, so that later ones must not destroy them.
TEST(Flips, RecoversMissingEdges) {
  std::size_t asked = 0, recovered = 0;
  for (std::uint64_t seed : {1, 2, 3, 4}) {
    Cloud cloud(random_points(200, seed));
    Tetrahedralization& mesh = cloud.mesh;
    std::mt19937_64 random(seed);
    for (int attempt = 0; attempt < 60; ++attempt) {
      const VertexId a(random() % cloud.store.size());
      // A close vertex: segments of a surface mesh are about as long as the edges around them.
      VertexId b;
      double nearest = 1;
      for (VertexId v : all_ids(cloud.store)) {
        const double d = distance(mesh.position(a), mesh.position(v));
        if (v != a && d < nearest && d > 0.12 && !mesh.find_edge(a, v)) b = v, nearest = d;
      }
      if (!b.valid()) continue;
      ++asked;
      const auto edges = all_edges(mesh.complex());
      const bool done = recover_edge_by_flips(mesh, a, b);
      ASSERT_EQ(done, mesh.find_edge(a, b).has_value());
      ASSERT_EQ(defects(mesh), "");
      if (!done) {
        EXPECT_EQ(all_edges(mesh.complex()), edges);
      }
      recovered += done;
    }
  }
  RecordProperty("asked", static_cast<int>(asked));
  RecordProperty("recovered", static_cast<int>(recovered));
  EXPECT_GT(asked, 100U);
  EXPECT_GT(static_cast<double>(recovered), 0.9 * static_cast<double>(asked));
}

TEST(Flips, RecoveryLeavesLocksAndKeptSegments) {
  std::size_t recovered = 0;
  for (std::uint64_t seed : {5, 6, 7}) {
    Cloud cloud(random_points(150, seed, seed == 7 ? 8 : 0));
    Tetrahedralization& mesh = cloud.mesh;
    lock_some(mesh, seed, 60);
    const auto locked = locked_facets(mesh.complex());
    std::mt19937_64 random(seed);
    std::vector<std::array<VertexId, 2>> kept;
    for (const auto& e : all_edges(mesh.complex())) {
      if (random() % 30 == 0) kept.push_back(e), mesh.keep_segment(e[0], e[1]);
    }
    for (int attempt = 0; attempt < 200; ++attempt) {
      const VertexId a(random() % cloud.store.size()), b(random() % cloud.store.size());
      if (distance(mesh.position(a), mesh.position(b)) > 0.35 || a == b || mesh.find_edge(a, b)) continue;
      recovered += recover_edge_by_flips(mesh, a, b);
      ASSERT_EQ(defects(mesh), "");
    }
    EXPECT_EQ(locked_facets(mesh.complex()), locked);
    for (const auto& [u, v] : kept) EXPECT_TRUE(mesh.find_edge(u, v));
  }
  EXPECT_GT(recovered, 20U);
}

TEST(Flips, RecoversMissingFacets) {
  std::size_t asked = 0, recovered = 0;
  for (std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    Cloud cloud(random_points(200, seed, seed == 6 ? 12 : 0));
    Tetrahedralization& mesh = cloud.mesh;
    std::mt19937_64 random(seed);
    for (int attempt = 0; attempt < 150; ++attempt) {
      // Three vertices joined by edges: one of the tet, one beyond a vertex of it.
      const TetId t(random() % mesh.complex().slots());
      if (!mesh.complex().is_alive(t) || mesh.complex().is_ghost(t)) continue;
      const VertexId a = mesh.complex().vertex(t, 0), b = mesh.complex().vertex(t, 1);
      const VertexId c(random() % cloud.store.size());
      if (c == a || c == b || distance(mesh.position(a), mesh.position(c)) > 0.4 || mesh.find_facet(a, b, c)) continue;
      if (!recover_edge_by_flips(mesh, a, c)) continue;
      mesh.keep_segment(a, c);
      const bool edges = mesh.find_edge(a, b) && recover_edge_by_flips(mesh, b, c) && mesh.find_edge(a, b);
      mesh.release_segment(a, c);
      if (!edges || mesh.find_facet(a, b, c)) continue;
      ++asked;
      for (const auto& [u, v] : {std::array{a, b}, std::array{b, c}, std::array{a, c}}) mesh.keep_segment(u, v);
      const bool done = recover_facet_by_flips(mesh, a, b, c);
      ASSERT_EQ(done, mesh.find_facet(a, b, c).has_value());
      ASSERT_EQ(defects(mesh), "");
      for (const auto& [u, v] : {std::array{a, b}, std::array{b, c}, std::array{a, c}}) mesh.release_segment(u, v);
      recovered += done;
    }
  }
  RecordProperty("asked", static_cast<int>(asked));
  RecordProperty("recovered", static_cast<int>(recovered));
  EXPECT_GT(asked, 20U);
  EXPECT_GT(static_cast<double>(recovered), 0.9 * static_cast<double>(asked));
}

}  // namespace
}  // namespace curvetet::test
