// Filling of cells and of the room that wanted triangles cross: whatever is done is valid, exactly, and keeps locks,
// kept segments, vertices and volume; what is refused has changed nothing.
#include "spatial/refill.h"

#include <gtest/gtest.h>

#include <set>

#include "geometry/frame.h"
#include "spatial/fill_cell.h"
#include "spatial/flips_support.h"
#include "spatial/triangles_cross.h"

namespace curvetet::test {
namespace {

using Triple = std::array<VertexId, 3>;

std::function<VertexId(Vec3)> adder(VertexStore& store) {
  return [&store](Vec3 p) { return store.add(snap(p), Owner{}, {}, Origin::steiner); };
}

/// The Schönhardt prism: its top turned so that the diagonals of its sides lie inwards. Sides face inwards.
std::vector<CellSide> twisted_prism(VertexStore& store, double turn) {
  for (int level = 0; level < 2; ++level)
    for (int k = 0; k < 3; ++k) {
      const double angle = (2 * k + 1.0) * 1.0471975511965976 + level * turn;
      store.add(snap(Vec3{0.25 * std::cos(angle), 0.25 * std::sin(angle), level * 0.25}), Owner{}, {},
                Origin::interior);
    }
  const auto v = [](std::size_t i) { return VertexId(i); };
  std::vector<CellSide> sides{{v(0), v(1), v(2)}, {v(3), v(5), v(4)}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    sides.push_back({v(k), v(3 + k), v(n)});
    sides.push_back({v(3 + k), v(3 + n), v(n)});
  }
  return sides;
}

double sixfold_volume_of(const VertexStore& store, const std::vector<TetComplex::Vertices>& tets) {
  double sum = 0;
  for (const auto& t : tets) {
    const Vec3 a = store.position(t[0]);
    EXPECT_GT(orient3d(a, store.position(t[1]), store.position(t[2]), store.position(t[3])), 0);
    sum += dot(cross(store.position(t[1]) - a, store.position(t[2]) - a), store.position(t[3]) - a);
  }
  return sum;
}

double sixfold_volume_within(const VertexStore& store, const std::vector<CellSide>& sides) {
  double sum = 0;
  for (const CellSide& s : sides) sum -= dot(cross(store.position(s[0]), store.position(s[1])), store.position(s[2]));
  return sum;
}

TEST(FillCell, ASchoenhardtPrismNeedsAPoint) {
  for (double turn : {0.25, 0.5}) {
    VertexStore store;
    const std::vector<CellSide> sides = twisted_prism(store, -turn);
    EXPECT_TRUE(fill_cell(store, sides, {}).tets.empty());
    const CellFill filled = fill_cell(store, sides, adder(store));
    ASSERT_FALSE(filled.tets.empty());
    EXPECT_EQ(filled.points, 1U);
    EXPECT_NEAR(sixfold_volume_of(store, filled.tets), sixfold_volume_within(store, sides), 1e-12);
  }
}

TEST(FillCell, ATwistTheOtherWayNeedsNone) {
  VertexStore store;
  const std::vector<CellSide> sides = twisted_prism(store, 0.25);
  const CellFill filled = fill_cell(store, sides, adder(store));
  ASSERT_FALSE(filled.tets.empty());
  EXPECT_EQ(filled.points, 0U);
  EXPECT_NEAR(sixfold_volume_of(store, filled.tets), sixfold_volume_within(store, sides), 1e-12);
}

/// Two triangles over a missing edge whose four outer edges exist.
std::optional<std::array<Triple, 2>> missing_pair(const Tetrahedralization& mesh, const VertexStore& store,
                                                  std::mt19937_64& random) {
  const std::size_t n = store.size();
  const VertexId a(random() % n), b(random() % n);
  if (a == b || mesh.find_edge(a, b)) return std::nullopt;
  std::vector<VertexId> both;
  for (VertexId c : all_ids(store))
    if (c != a && c != b && mesh.find_edge(a, c) && mesh.find_edge(b, c)) both.push_back(c);
  for (VertexId c : both)
    for (VertexId d : both)
      if (c < d && !triangles_cross(store, {a, b, c}, {b, a, d})) return {{Triple{a, b, c}, Triple{b, a, d}}};
  return std::nullopt;
}

void lock_far_facets(Tetrahedralization& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const TetComplex& complex = mesh.complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    if (!complex.is_alive(TetId(k)) || complex.is_ghost(TetId(k))) continue;
    if (random() % 8 == 0) mesh.lock({TetId(k), 0}, FaceId(random() % 5));
    if (random() % 8 == 0) mesh.keep_segment(complex.vertex(TetId(k), 0), complex.vertex(TetId(k), 1));
  }
}

TEST(Refill, KeepsEverythingAndMakesTheTrianglesFacets) {
  int done = 0, refused = 0, with_points = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Cloud cloud(random_points(120, seed, seed % 3 == 0 ? 4 : 0));
    if (seed % 2 == 0) lock_far_facets(cloud.mesh, seed);
    const double volume = sixfold_volume(cloud.mesh);
    std::mt19937_64 random(seed);
    for (int trial = 0; trial < 60; ++trial) {
      const auto pair = missing_pair(cloud.mesh, cloud.store, random);
      if (!pair) continue;
      const auto locks = locked_facets(cloud.mesh.complex());
      const RefillResult result = refill(cloud.mesh, *pair, {40, adder(cloud.store)});
      ASSERT_EQ(defects(cloud.mesh), "");
      EXPECT_NEAR(sixfold_volume(cloud.mesh), volume, 1e-12);
      EXPECT_EQ(locked_facets(cloud.mesh.complex()), locks);
      for (const auto& [p, q] : cloud.mesh.kept_segments()) EXPECT_TRUE(cloud.mesh.find_edge(p, q));
      ++(result.done ? done : refused);
      with_points += result.points > 0 ? 1 : 0;
      for (const Triple& t : *pair) EXPECT_TRUE(!result.done || cloud.mesh.find_facet(t[0], t[1], t[2]));
      for (VertexId v : all_ids(cloud.store))
        EXPECT_TRUE(cloud.mesh.contains(v) || cloud.store.origin(v) == Origin::steiner);
    }
  }
  EXPECT_GT(done, 100);
  EXPECT_GT(refused, 0);
  EXPECT_GT(with_points, 0);
}

TEST(Refill, RefusesToCrossALockedFacet) {
  VertexStore store;
  for (Vec3 p :
       {Vec3{0, 0, 0}, Vec3{0.25, 0, 0}, Vec3{0, 0.25, 0}, Vec3{0.0625, 0.0625, 0.05}, Vec3{0.0625, 0.0625, -0.05}})
    store.add(p, Owner{}, {}, Origin::interior);
  Cloud cloud(store);
  const auto facet = cloud.mesh.find_facet(VertexId(0), VertexId(1), VertexId(2));
  if (!facet) {
    ASSERT_TRUE(refill(cloud.mesh, std::vector<Triple>{{VertexId(0), VertexId(1), VertexId(2)}}, {}).done);
  }
  cloud.mesh.lock(*cloud.mesh.find_facet(VertexId(0), VertexId(1), VertexId(2)), FaceId(3));
  const std::vector<Triple> through{{VertexId(0), VertexId(3), VertexId(4)}};
  EXPECT_FALSE(refill(cloud.mesh, through, {40, adder(cloud.store)}).done);
  EXPECT_EQ(defects(cloud.mesh), "");
}

}  // namespace
}  // namespace curvetet::test
