// Building and inserting, on random and degenerate points: against the definition, against the checker, against itself.
#include "spatial/tetrahedralization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "oracle/naive_delaunay.h"
#include "oracle/point_sets.h"
#include "spatial/check.h"

namespace curvetet {
namespace {

using oracle::all_vertices;
using oracle::finite_tets;
using oracle::make_store;
using oracle::PointSet;

class OnPointSet : public testing::TestWithParam<PointSet> {};
INSTANTIATE_TEST_SUITE_P(All, OnPointSet, testing::ValuesIn(oracle::kPointSets),
                         [](const auto& param) { return oracle::name(param.param); });

void expect_valid(const Tetrahedralization& mesh, bool delaunay = true) {
  for (const std::string& finding : check_tetrahedralization(mesh, delaunay)) ADD_FAILURE() << finding;
}

TEST_P(OnPointSet, BuildIsTheDelaunayTetrahedralizationByDefinition) {
  const Context context;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const VertexStore store = make_store(GetParam(), 8 + seed % 9, seed);
    Tetrahedralization mesh(store, seed);
    const Status status = mesh.build(all_vertices(store), context);
    if (oracle::naive_delaunay(store).empty()) {
      EXPECT_FALSE(status.ok());
      continue;
    }
    ASSERT_TRUE(status.ok()) << status.error().message;
    EXPECT_EQ(finite_tets(mesh), oracle::naive_delaunay(store));
    expect_valid(mesh);
  }
}

TEST_P(OnPointSet, ManyPointsGiveAValidTetrahedralization) {
  const Context context;
  const VertexStore store = make_store(GetParam(), 3000, 99);
  Tetrahedralization mesh(store, 7);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  expect_valid(mesh);
  for (const VertexId v : all_vertices(store)) EXPECT_TRUE(mesh.contains(v));
}

TEST_P(OnPointSet, InsertingOneByOneGivesTheSameTetsAsBuilding) {
  const Context context;
  VertexStore store = make_store(GetParam(), 400, 3);
  // A proper tet off the set's planes to start from, so that all others can be in any order, also outside its hull.
  const std::size_t first = store.size();
  for (const Vec3 p :
       {Vec3{0.01, 0.02, -0.51}, Vec3{0.05, 0.03, -0.52}, Vec3{0.03, 0.06, -0.5}, Vec3{0.02, 0.04, -0.4}}) {
    store.add(oracle::to_grid(p), {}, {}, Origin::interior);
  }
  std::vector<VertexId> ids = all_vertices(store);
  Tetrahedralization built(store, 1);
  ASSERT_TRUE(built.build(ids, context).ok());
  Tetrahedralization inserted(store, 1);
  ASSERT_TRUE(inserted.build(std::span(ids).subspan(first), context).ok());
  ids.resize(first);
  std::shuffle(ids.begin(), ids.end(), std::mt19937_64(17));
  for (const VertexId v : ids) ASSERT_EQ(inserted.insert(v), Refusal::none);
  EXPECT_EQ(finite_tets(inserted), finite_tets(built));
  expect_valid(inserted);
}

TEST_P(OnPointSet, TheOrderOfTheIdsGivenDoesNotMatter) {
  const Context context;
  const VertexStore store = make_store(GetParam(), 500, 5);
  std::vector<VertexId> ids = all_vertices(store);
  Tetrahedralization one(store, 4), other(store, 4);
  ASSERT_TRUE(one.build(ids, context).ok());
  std::shuffle(ids.begin(), ids.end(), std::mt19937_64(5));
  ASSERT_TRUE(other.build(ids, context).ok());
  ASSERT_EQ(one.complex().slots(), other.complex().slots());
  for (std::size_t slot = 0; slot < one.complex().slots(); ++slot) {
    ASSERT_EQ(one.complex().vertices(TetId(slot)), other.complex().vertices(TetId(slot)));
  }
}

TEST_P(OnPointSet, AnotherSeedGivesTheSameTets) {
  const Context context;
  const VertexStore store = make_store(GetParam(), 500, 6);
  Tetrahedralization one(store, 4), other(store, 5);
  ASSERT_TRUE(one.build(all_vertices(store), context).ok());
  ASSERT_TRUE(other.build(all_vertices(store), context).ok());
  EXPECT_EQ(finite_tets(one), finite_tets(other));
}

TEST_P(OnPointSet, QueriesAgreeWithAScan) {
  const Context context;
  const VertexStore store = make_store(GetParam(), 200, 8);
  Tetrahedralization mesh(store, 4);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  const TetComplex& complex = mesh.complex();
  std::vector<TetId> star, ring;
  for (const VertexId v : all_vertices(store)) {
    mesh.star(v, star);
    std::sort(star.begin(), star.end());
    EXPECT_EQ(std::adjacent_find(star.begin(), star.end()), star.end());
    std::vector<TetId> scanned;
    for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
      if (complex.is_alive(TetId(slot)) && complex.local(TetId(slot), v) >= 0) scanned.push_back(TetId(slot));
    }
    ASSERT_EQ(star, scanned);
  }
  for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
    const TetId t(slot);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    for (const auto& [i, j] : kEdge) {
      const VertexId a = complex.vertex(t, i), b = complex.vertex(t, j);
      ASSERT_TRUE(mesh.find_edge(a, b).has_value());
      mesh.ring({t, i, j}, ring);
      ASSERT_EQ(ring.front(), t);
      mesh.star(a, star);
      ASSERT_EQ(static_cast<long>(ring.size()),
                std::count_if(star.begin(), star.end(), [&](TetId s) { return complex.local(s, b) >= 0; }));
    }
    const auto facet = mesh.find_facet(complex.vertex(t, 2), complex.vertex(t, 0), complex.vertex(t, 1));
    ASSERT_TRUE(facet.has_value());
    ASSERT_TRUE(facet->tet == t || complex.mirror(*facet).tet == t);
  }
  EXPECT_FALSE(mesh.find_edge(VertexId(0), VertexId(0)).has_value());
}

TEST_P(OnPointSet, LocateFindsATetThatHoldsThePoint) {
  const Context context;
  const VertexStore store = make_store(GetParam(), 300, 9);
  Tetrahedralization mesh(store, 4);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  oracle::PointSource places(GetParam(), 1234);
  oracle::PointSource everywhere(PointSet::cube, 1234);
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = k % 2 == 0 ? places.next() : everywhere.next();
    const TetId t = mesh.locate(p);
    const int infinite = mesh.complex().local(t, kInfinite);
    for (int i = 0; i < 4; ++i) {
      std::array<Vec3, 4> x;
      if (infinite >= 0 && i != infinite) continue;
      for (int j = 0; j < 4; ++j) {
        const auto at = static_cast<std::size_t>(j);
        x[at] = j == i ? p : mesh.position(mesh.complex().vertex(t, j));
      }
      ASSERT_GE(orient3d(x[0], x[1], x[2], x[3]), infinite >= 0 ? 1 : 0);
    }
  }
}

TEST_P(OnPointSet, TheScanThatBacksTheWalkFindsATetToo) {
  const Context context;
  const VertexStore store = make_store(GetParam(), 60, 9);
  Tetrahedralization mesh(store, 4);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  oracle::PointSource everywhere(PointSet::cube, 77);
  kernel::Stream stream(1);
  for (int k = 0; k < 50; ++k) {
    const Vec3 p = everywhere.next();
    const TetId scanned = kernel::walk(mesh.complex(), kernel::Sites{store.sites()}, p, TetId(), stream);
    ASSERT_TRUE(scanned.valid());
    // A ghost, where several see the point, need not be the same one.
    if (mesh.complex().is_ghost(scanned)) {
      ASSERT_TRUE(mesh.complex().is_ghost(mesh.locate(p)));
    } else {
      ASSERT_EQ(mesh.locate(p), scanned);
    }
  }
}

TEST(Ring, TurnsRightHandedAroundTheEdge) {
  VertexStore store;
  for (const Vec3 p :
       {Vec3{0, 0, -0.125}, Vec3{0, 0, 0.125}, Vec3{0.25, 0, 0}, Vec3{0, 0.25, 0}, Vec3{-0.25, -0.25, 0}}) {
    store.add(p, {}, {}, Origin::interior);
  }
  Tetrahedralization mesh(store, 1);
  const Context context;
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  const auto edge = mesh.find_edge(VertexId(0), VertexId(1));
  ASSERT_TRUE(edge.has_value());
  std::vector<TetId> ring;
  mesh.ring(*edge, ring);
  ASSERT_EQ(ring.size(), 3U);
  const auto angle = [&](TetId t) {
    Vec3 sum;
    for (const VertexId v : mesh.complex().vertices(t)) sum = sum + mesh.position(v);
    return std::atan2(sum.y, sum.x);
  };
  int falls = 0;
  for (std::size_t k = 0; k < 3; ++k) falls += angle(ring[(k + 1) % 3]) < angle(ring[k]) ? 1 : 0;
  EXPECT_EQ(falls, 1);
}

TEST(Build, RefusesWhatHasNoTetrahedralization) {
  const Context context;
  VertexStore store;
  Tetrahedralization mesh(store, 1);
  EXPECT_FALSE(mesh.build({}, context).ok());
  for (int i = 0; i < 5; ++i) store.add({0.125 * i, 0, 0}, {}, {}, Origin::interior);
  EXPECT_FALSE(mesh.build(all_vertices(store), context).ok());  // collinear
  for (int i = 0; i < 5; ++i) store.add({0.125 * i, 0.5, 0}, {}, {}, Origin::interior);
  EXPECT_FALSE(mesh.build(all_vertices(store), context).ok());  // coplanar
  EXPECT_EQ(mesh.complex().alive(), 0U);
  EXPECT_EQ(mesh.insert(VertexId(0)), Refusal::outside);
  store.add({0, 0, 0.5}, {}, {}, Origin::interior);
  EXPECT_TRUE(mesh.build(all_vertices(store), context).ok());
  store.add({0.25, 0.5, 0}, {}, {}, Origin::interior);
  const Status status = mesh.build(all_vertices(store), context);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().entities, (std::vector<std::string>{"vertex 7", "vertex 11"}));
}

TEST(Build, StopsWhenCancelled) {
  Context context;
  const VertexStore store = make_store(PointSet::cube, 3000, 1);
  Tetrahedralization mesh(store, 1);
  context.cancel();
  const Status status = mesh.build(all_vertices(store), context);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::cancelled);
  EXPECT_EQ(mesh.complex().alive(), 0U);
}

TEST(Insert, RefusesADuplicateAndChangesNothing) {
  const Context context;
  VertexStore store = make_store(PointSet::cube, 50, 1);
  Tetrahedralization mesh(store, 1);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  const auto before = finite_tets(mesh);
  const VertexId twin = store.add(store.position(VertexId(17)), {}, {}, Origin::interior);
  EXPECT_EQ(mesh.insert(twin), Refusal::duplicate);
  EXPECT_EQ(finite_tets(mesh), before);
  EXPECT_FALSE(mesh.contains(twin));
}

/// A vertex that sees hundreds of facets, beyond what the table of edges holds.
TEST(Insert, AHubOfManyTets) {
  const Context context;
  VertexStore store = make_store(PointSet::sphere, 1000, 1);
  const std::vector<VertexId> ids = all_vertices(store);
  Tetrahedralization mesh(store, 1);
  ASSERT_TRUE(mesh.build(ids, context).ok());
  const VertexId hub = store.add({0, 0, 0}, {}, {}, Origin::interior);
  ASSERT_EQ(mesh.insert(hub), Refusal::none);
  EXPECT_GT(mesh.last_star().size(), 500U);
  expect_valid(mesh);
  Tetrahedralization built(store, 1);
  ASSERT_TRUE(built.build(all_vertices(store), context).ok());
  EXPECT_EQ(finite_tets(mesh), finite_tets(built));
}

TEST(Insert, FarPointsBeyondTheHullInEveryDirection) {
  const Context context;
  VertexStore store = make_store(PointSet::flat_and_apex, 60, 1);
  Tetrahedralization mesh(store, 1);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Refusal refusal = mesh.insert(store.add({x, y, z}, {}, {}, Origin::interior));
        EXPECT_TRUE(refusal == Refusal::none || refusal == Refusal::duplicate);
      }
    }
  }
  expect_valid(mesh);
}

TEST(Insert, FindingACavityChangesNothing) {
  const Context context;
  VertexStore store = make_store(PointSet::lattice, 100, 1);
  Tetrahedralization mesh(store, 1);
  ASSERT_TRUE(mesh.build(all_vertices(store), context).ok());
  const auto before = finite_tets(mesh);
  const VertexId v = store.add(oracle::to_grid({0.3, 0.4, 0.35}), {}, {}, Origin::interior);
  const Cavity one = mesh.find_cavity(v);
  const Cavity other = mesh.find_cavity(v);
  ASSERT_TRUE(one.ok());
  EXPECT_EQ(one.tets, other.tets);
  EXPECT_EQ(one.boundary, other.boundary);
  EXPECT_EQ(finite_tets(mesh), before);
  expect_valid(mesh);
  Insertion insertion;
  CavityScratch scratch;
  mesh.find_cavity_at(store.position(v), mesh.locate(store.position(v)), scratch, insertion.cavity);
  EXPECT_EQ(insertion.cavity.tets, one.tets);
  EXPECT_EQ(insertion.cavity.boundary, one.boundary);
  mesh.commit(one);
  EXPECT_TRUE(mesh.contains(v));
  EXPECT_EQ(mesh.last_star().size(), one.boundary.size());
  expect_valid(mesh);
}

/// Cavities that have nothing in common are found first and committed then, as refinement does on many threads: the
/// outcome is that of one insertion after the other.
TEST(Insert, ManyAtATime) {
  const Context context;
  VertexStore store = make_store(PointSet::cube, 2000, 1), again = store;
  Tetrahedralization many(store, 1), one_by_one(again, 1);
  ASSERT_TRUE(many.build(all_vertices(store), context).ok());
  ASSERT_TRUE(one_by_one.build(all_vertices(again), context).ok());
  std::vector<Vec3> places;
  for (const double x : {-0.6, 0.0, 0.6})
    for (const double y : {-0.6, 0.0, 0.6})
      for (const double z : {-0.6, 0.0, 0.6}) places.push_back(oracle::to_grid({x, y, z}));
  std::vector<Insertion> insertions(places.size());
  CavityScratch scratch;
  for (std::size_t k = 0; k < places.size(); ++k) {
    many.find_cavity_at(places[k], many.locate(places[k]), scratch, insertions[k].cavity);
    ASSERT_TRUE(insertions[k].cavity.ok());
    many.note_walls(insertions[k]);
  }
  for (std::size_t k = 0; k < places.size(); ++k)
    many.reserve(insertions[k], store.add(places[k], {}, {}, Origin::interior));
  kernel::StarBuilder builder;
  for (Insertion& insertion : insertions) many.commit(insertion, builder);
  for (Insertion& insertion : insertions) many.settle(insertion);
  many.link_vertices();
  expect_valid(many);
  for (const Vec3& p : places) ASSERT_EQ(one_by_one.insert(again.add(p, {}, {}, Origin::interior)), Refusal::none);
  EXPECT_EQ(finite_tets(many), finite_tets(one_by_one));
}

/// The corners of all finite tets by their places, sorted.
std::set<std::array<std::array<double, 3>, 4>> tets_by_place(const Tetrahedralization& mesh) {
  std::set<std::array<std::array<double, 3>, 4>> tets;
  for (std::size_t k = 0; k < mesh.complex().slots(); ++k) {
    if (!mesh.complex().is_alive(TetId(k)) || mesh.complex().is_ghost(TetId(k))) continue;
    std::array<std::array<double, 3>, 4> corners{};
    for (int i = 0; i < 4; ++i) {
      const Vec3 p = mesh.position(mesh.complex().vertex(TetId(k), i));
      corners[static_cast<std::size_t>(i)] = {p.x, p.y, p.z};
    }
    std::sort(corners.begin(), corners.end());
    tets.insert(corners);
  }
  return tets;
}

TEST(SortInSpace, ChangesNumbersOnly) {
  const Context context;
  VertexStore store = make_store(PointSet::cube, 3000, 1);
  Tetrahedralization mesh(store, 1);
  const std::vector<VertexId> ids = all_vertices(store);
  const VertexId first(2000U);
  ASSERT_TRUE(mesh.build(std::span(ids).first(2000), context).ok());
  const TetId some = mesh.tet_of(VertexId(7));
  const auto facet = mesh.complex().facet_vertices({some, 0});
  mesh.lock({some, 0}, FaceId(3));
  mesh.keep_segment(facet[0], facet[1]);
  for (std::size_t k = 2000; k < ids.size(); ++k) mesh.insert(ids[k]);
  const auto tets = tets_by_place(mesh);
  const auto length_of_steps = [&] {
    double sum = 0;
    for (std::size_t v = first.value(); v + 1 < store.size(); ++v)
      sum += distance(store.position(VertexId(v)), store.position(VertexId(v + 1)));
    return sum;
  };
  const double before = length_of_steps();
  const Vec3 fixed = store.position(VertexId(1999));
  mesh.sort_in_space(store, first, context);
  expect_valid(mesh, false);
  EXPECT_EQ(tets_by_place(mesh), tets);
  EXPECT_EQ(mesh.complex().alive(), mesh.complex().slots());
  EXPECT_EQ(store.position(VertexId(1999)), fixed);
  EXPECT_LT(length_of_steps(), 0.3 * before) << "neighbours are near";
  const auto locked = mesh.find_facet(facet[0], facet[1], facet[2]);
  ASSERT_TRUE(locked);
  EXPECT_EQ(mesh.complex().locked_face(*locked), FaceId(3));
  EXPECT_TRUE(mesh.is_kept(facet[0], facet[1]));
  const VertexId more = store.add(oracle::to_grid({0.01, 0.02, 0.03}), {}, {}, Origin::interior);
  EXPECT_EQ(mesh.insert(more), Refusal::none);
  expect_valid(mesh, false);
}

}  // namespace
}  // namespace curvetet
