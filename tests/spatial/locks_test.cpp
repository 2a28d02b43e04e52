// Locked facets and kept segments survive every insertion, and the tetrahedralization stays valid.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "oracle/naive_delaunay.h"
#include "oracle/point_sets.h"
#include "spatial/check.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {
namespace {

using oracle::all_vertices;
using oracle::PointSet;

struct LockedFacet {
  std::array<VertexId, 3> vertices;
  FaceId face;
};

/// A tetrahedralization with random locks, to be filled with points.
class Locked {
 public:
  Locked(PointSet set, std::uint64_t seed)
      : store_(oracle::make_store(set, 60, seed)), mesh_(store_, seed), random_(seed) {
    const Context context;
    built_ = mesh_.build(all_vertices(store_), context).ok();
  }
  bool built() const { return built_; }
  Tetrahedralization& mesh() { return mesh_; }

  /// Locks each finite facet between the tets on the two sides of a random plane: a sheet through everything.
  void lock_sheet(FaceId face) {
    const Vec3 normal{uniform(), uniform(), uniform()};
    const double offset = 0.2 * uniform();
    lock_if(face, [&](TetFacet f) {
      return beyond(f.tet, normal, offset) != beyond(mesh_.complex().mirror(f).tet, normal, offset);
    });
  }
  void lock_some(FaceId face, double share) {
    lock_if(face, [&](TetFacet) { return std::uniform_real_distribution<double>()(random_) < share; });
  }
  void keep_some(double share) {
    for (const TetId t : tets()) {
      for (const auto& [i, j] : kEdge) {
        const VertexId a = mesh_.complex().vertex(t, i), b = mesh_.complex().vertex(t, j);
        if (a == kInfinite || b == kInfinite || std::uniform_real_distribution<double>()(random_) > share) continue;
        mesh_.keep_segment(a, b);
        kept_.insert({std::min(a, b), std::max(a, b)});
      }
    }
  }

  Refusal insert(Vec3 p) {
    const VertexId v = store_.add(p, {}, {}, Origin::interior);
    return mesh_.insert(v);
  }

  void expect_intact(bool delaunay = false) {
    for (const std::string& finding : check_tetrahedralization(mesh_, delaunay)) ADD_FAILURE() << finding;
    EXPECT_EQ(mesh_.complex().locked_count(), locked_.size());
    for (const LockedFacet& f : locked_) {
      const auto found = mesh_.find_facet(f.vertices[0], f.vertices[1], f.vertices[2]);
      ASSERT_TRUE(found.has_value());
      ASSERT_TRUE(mesh_.complex().is_locked(*found));
      ASSERT_EQ(mesh_.complex().locked_face(*found), f.face);
    }
    for (const auto& [a, b] : kept_) ASSERT_TRUE(mesh_.find_edge(a, b).has_value());
  }

 private:
  std::vector<TetId> tets() const {
    std::vector<TetId> out;
    for (std::size_t slot = 0; slot < mesh_.complex().slots(); ++slot) {
      if (mesh_.complex().is_alive(TetId(slot))) out.emplace_back(slot);
    }
    return out;
  }
  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  bool beyond(TetId t, Vec3 normal, double offset) const {
    if (mesh_.complex().is_ghost(t)) return false;
    Vec3 sum;
    for (const VertexId v : mesh_.complex().vertices(t)) sum = sum + mesh_.position(v);
    return dot(0.25 * sum, normal) > offset;
  }
  template <class Condition>
  void lock_if(FaceId face, Condition condition) {
    for (const TetId t : tets()) {
      for (int i = 0; i < 4; ++i) {
        const TetFacet f{t, i};
        const auto v = mesh_.complex().facet_vertices(f);
        if (v[0] == kInfinite || v[1] == kInfinite || v[2] == kInfinite) continue;
        if (mesh_.complex().is_locked(f) || !condition(f)) continue;
        mesh_.lock(f, face);
        locked_.push_back({v, face});
      }
    }
  }

  VertexStore store_;
  Tetrahedralization mesh_;
  std::mt19937_64 random_;
  bool built_ = false;
  std::vector<LockedFacet> locked_;
  std::set<std::pair<VertexId, VertexId>> kept_;
};

class LocksOn : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(All, LocksOn, testing::ValuesIn(oracle::kPointSets),
                         [](const auto& param) { return oracle::name(param.param); });

/// Points among the set's own places and all over the box, inside and outside the hull.
void fill(Locked& body, PointSet set, std::uint64_t seed, int points) {
  oracle::PointSource near(set, seed), anywhere(PointSet::cube, seed);
  for (int k = 0; k < points; ++k) {
    const Refusal refusal = body.insert(k % 2 == 0 ? near.next() : oracle::to_grid(0.6 * anywhere.next()));
    ASSERT_NE(refusal, Refusal::locked_cavity);
    ASSERT_NE(refusal, Refusal::outside);
    if (k % 8 == 0) body.expect_intact();
    if (testing::Test::HasFatalFailure()) return;
  }
  body.expect_intact();
}

TEST_P(LocksOn, ASheetSurvives) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Locked body(GetParam(), seed);
    ASSERT_TRUE(body.built());
    body.lock_sheet(FaceId(1));
    body.lock_sheet(FaceId(2));
    fill(body, GetParam(), seed + 100, 120);
  }
}

TEST_P(LocksOn, ScatteredFacetsSurvive) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Locked body(GetParam(), seed);
    ASSERT_TRUE(body.built());
    body.lock_some(FaceId(3), 0.1);
    fill(body, GetParam(), seed + 200, 120);
  }
}

TEST_P(LocksOn, KeptSegmentsSurvive) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Locked body(GetParam(), seed);
    ASSERT_TRUE(body.built());
    body.keep_some(0.1);
    body.lock_some(FaceId(3), 0.05);
    fill(body, GetParam(), seed + 300, 120);
  }
}

/// One tet about the origin, with a vertex far below.
struct Simple {
  VertexStore store;
  Tetrahedralization mesh{store, 1};
  Simple() {
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{0.5, 0, 0}, Vec3{0, 0.5, 0}, Vec3{0, 0, 0.5}, Vec3{0.1, 0.1, -0.5}}) {
      store.add(oracle::to_grid(p), {}, {}, Origin::interior);
    }
    const Context context;
    EXPECT_TRUE(mesh.build(all_vertices(store), context).ok());
  }
  Refusal insert(Vec3 p) { return mesh.insert(store.add(p, {}, {}, Origin::interior)); }
  void lock(int a, int b, int c) {
    const auto f = mesh.find_facet(VertexId(a), VertexId(b), VertexId(c));
    ASSERT_TRUE(f.has_value());
    mesh.lock(*f, FaceId(5));
  }
};

TEST(Refusals, APointOnALockedFacet) {
  Simple simple;
  simple.lock(0, 1, 2);
  EXPECT_EQ(simple.insert({0.125, 0.125, 0}), Refusal::on_locked_facet);
  EXPECT_EQ(simple.insert({0.25, 0.25, 0}), Refusal::on_locked_facet);  // on its edge, which is on the hull
  EXPECT_EQ(simple.insert({0.25, 0, 0}), Refusal::on_locked_facet);
  EXPECT_EQ(simple.insert({0.375, 0.375, 0}), Refusal::none);  // in its plane, beside it
  EXPECT_EQ(simple.insert({0.125, 0.125, 0x1p-42}), Refusal::none);
  EXPECT_TRUE(check_tetrahedralization(simple.mesh, false).empty());
}

TEST(Refusals, APointOnALockedHullFacet) {
  Simple simple;
  simple.lock(0, 1, 3);
  EXPECT_EQ(simple.insert({0.125, 0, 0.125}), Refusal::on_locked_facet);
  EXPECT_EQ(simple.insert({0.125, -0.125, 0.125}), Refusal::none);  // beyond it
  EXPECT_TRUE(check_tetrahedralization(simple.mesh, false).empty());
  EXPECT_TRUE(simple.mesh.find_facet(VertexId(0), VertexId(1), VertexId(3)).has_value());
}

TEST(Refusals, APointOnAKeptSegment) {
  Simple simple;
  simple.mesh.keep_segment(VertexId(1), VertexId(0));
  EXPECT_TRUE(simple.mesh.is_kept(VertexId(0), VertexId(1)));
  EXPECT_EQ(simple.insert({0.25, 0, 0}), Refusal::on_kept_segment);
  simple.mesh.release_segment(VertexId(0), VertexId(1));
  EXPECT_FALSE(simple.mesh.is_kept(VertexId(0), VertexId(1)));
  EXPECT_EQ(simple.insert({0.25, 0, 0}), Refusal::none);
  EXPECT_TRUE(check_tetrahedralization(simple.mesh, true).empty());
}

TEST(Regions, AreCarriedIntoTheNewTets) {
  Simple simple;
  simple.lock(0, 1, 2);
  TetComplex& complex = simple.mesh.complex();
  for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
    const TetId t(slot);
    if (complex.is_alive(t) && !complex.is_ghost(t)) complex.set_region(t, complex.local(t, VertexId(3)) >= 0 ? 4 : 9);
  }
  ASSERT_EQ(simple.insert({0.0625, 0.0625, 0.0625}), Refusal::none);
  for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
    const TetId t(slot);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    const bool upper = complex.local(t, VertexId(4)) < 0;
    EXPECT_EQ(complex.region(t), upper ? 4U : 9U);
  }
}

}  // namespace
}  // namespace curvetet
