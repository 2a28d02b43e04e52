// The numbered lines of predicates.h as properties, every rung against arbitrary precision, and the meeting of segments
// and triangles against a brute force in rationals.
#include "predicates/predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "oracle/exact_predicates.h"

namespace curvetet {
namespace {

/// Grid points of many kinds: from the whole box, tiny clusters, lattices, planes and spheres.
class Points {
 public:
  explicit Points(std::uint64_t seed) : random_(seed) {}

  Vec3 point(int kind) {
    switch (kind) {
      case 0:
        return {coordinate(1), coordinate(1), coordinate(1)};
      case 1:
        return {0.3 + coordinate(0x1p-38), -0.7 + coordinate(0x1p-38), coordinate(0x1p-38)};
      case 2:
        return {lattice(2), lattice(2), lattice(2)};
      case 3:
        return {coordinate(1), coordinate(1), 0.25};
      case 4:
        return on_sphere();
      case 5:
        return {corner(), corner(), corner()};
      default:
        return plane();
    }
  }
  static constexpr int kKinds = 7;

 private:
  double snap(double x) { return std::nearbyint(x * 0x1p42) * 0x1p-42; }
  double coordinate(double size) { return snap(size * std::uniform_real_distribution<double>(-1, 1)(random_)); }
  double lattice(int n) { return std::uniform_int_distribution<int>(-n, n)(random_) * 0.125; }
  double corner() { return std::uniform_int_distribution<int>(0, 1)(random_) == 0 ? -1 : 1; }
  Vec3 on_sphere() {
    std::normal_distribution<double> normal;
    const Vec3 p = 0.9 * normalized(Vec3{normal(random_), normal(random_), normal(random_)});
    return {snap(p.x), snap(p.y), snap(p.z)};
  }
  Vec3 plane() {  // x + y + z = 0, exactly
    const double x = snap(0.5 * coordinate(1));
    const double y = snap(0.5 * coordinate(1));
    return {x, y, -x - y};
  }

  std::mt19937_64 random_;
};

constexpr int kRounds = 1500;

TEST(Orient3d, HasTheDocumentedSign) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
}

TEST(Orient3d, EveryRungAgreesWithArbitraryPrecision) {
  Points points(1);
  for (int round = 0; round < kRounds; ++round) {
    for (int kind = 0; kind < Points::kKinds; ++kind) {
      const Vec3 a = points.point(kind), b = points.point(kind), c = points.point(kind), d = points.point(kind);
      const int truth = oracle::orient3d(a, b, c, d);
      const int filtered = rungs::orient3d_filter(a, b, c, d);
      ASSERT_TRUE(filtered == 2 || filtered == truth);
      ASSERT_EQ(rungs::orient3d_exact(a, b, c, d), truth);
      ASSERT_EQ(orient3d(a, b, c, d), truth);
    }
  }
}

TEST(Orient3d, PermutationsKeepOrNegateTheSign) {
  Points points(2);
  for (int round = 0; round < 200; ++round) {
    const int kind = round % Points::kKinds;
    const std::array<Vec3, 4> p{points.point(kind), points.point(kind), points.point(kind), points.point(kind)};
    const int truth = orient3d(p[0], p[1], p[2], p[3]);
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    do {
      int parity = 1;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) parity = order[i] > order[j] ? -parity : parity;
      }
      ASSERT_EQ(orient3d(p[order[0]], p[order[1]], p[order[2]], p[order[3]]), parity * truth);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Insphere, HasTheDocumentedSign) {
  EXPECT_EQ(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.5, -0.5, -0.5}), -1);
  EXPECT_EQ(insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}), 0);
}

TEST(Insphere, EveryRungAgreesWithArbitraryPrecision) {
  Points points(3);
  for (int round = 0; round < kRounds; ++round) {
    for (int kind = 0; kind < Points::kKinds; ++kind) {
      const Vec3 a = points.point(kind), b = points.point(kind), c = points.point(kind), d = points.point(kind);
      const Vec3 e = points.point(kind);
      const int truth = oracle::insphere(a, b, c, d, e);
      const int filtered = rungs::insphere_filter(a, b, c, d, e);
      ASSERT_TRUE(filtered == 2 || filtered == truth);
      const int extended = rungs::insphere_extended(a, b, c, d, e);
      ASSERT_TRUE(extended == 2 || extended == truth);
      ASSERT_EQ(rungs::insphere_exact(a, b, c, d, e), truth);
      ASSERT_EQ(insphere(a, b, c, d, e), truth);
    }
  }
}

TEST(Insphere, TheWidestInputsFit) {
  const double x = 1;
  const double y = 1 - 0x1p-42;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? x : -y, i & 2 ? y : -x, i & 4 ? x : -x});
  for (const Vec3 a : corners) {
    for (const Vec3 b : corners) {
      for (const Vec3 e : corners) {
        const Vec3 c = corners[3], d = corners[6];
        ASSERT_EQ(rungs::insphere_exact(a, b, c, d, e), oracle::insphere(a, b, c, d, e));
        ASSERT_EQ(rungs::orient3d_exact(a, b, c, e), oracle::orient3d(a, b, c, e));
      }
    }
  }
}

TEST(Insphere, TheExpectedRungDecides) {
  predicate_counts() = {};
  insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25, 0.25, 0.25});
  EXPECT_EQ(predicate_counts().filter, 1U);
  insphere({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1});
  EXPECT_EQ(predicate_counts().extended, 1U);
  const double s = 1 - 0x1p-40;  // a cube whose steps do not divide out to 24 bits
  insphere({0, 0, 0x1p-42}, {s, 0, 0x1p-42}, {0, s, 0x1p-42}, {0, 0, s + 0x1p-42}, {s, s, s + 0x1p-42});
  EXPECT_EQ(predicate_counts().exact + predicate_counts().extended, 2U);
}

/// The perturbed predicate, checked against numbers: heights raised by steeply falling amounts by falling id.
int insphere_of_raised_heights(const std::array<Vec3, 5>& p, const std::array<VertexId, 5>& ids) {
  using oracle::Integer;
  oracle::Matrix rows;
  for (std::size_t i = 0; i < 5; ++i) {
    std::vector<Integer> r = oracle::lifted(oracle::row(p[i]));
    for (Integer& x : r) x <<= 3000;
    r[3] += Integer(1) << static_cast<unsigned>(400 * (ids[i].value() + 1));
    r.push_back(1);
    rows.push_back(r);
  }
  return -oracle::determinant(rows).sign();
}

TEST(InspherePerturbed, IsTheSignOfRaisedHeights) {
  Points points(4);
  std::mt19937_64 random(5);
  for (int round = 0; round < 400; ++round) {
    const int kind = round % 3 == 0 ? 2 : round % 3 == 1 ? 5 : 3;
    std::array<Vec3, 5> p;
    for (Vec3& x : p) x = points.point(kind);
    std::array<std::uint32_t, 5> order{0, 1, 2, 3, 4};
    std::shuffle(order.begin(), order.end(), random);
    std::array<VertexId, 5> ids;
    for (std::size_t i = 0; i < 5; ++i) ids[i] = VertexId(order[i]);
    ASSERT_EQ(insphere_perturbed(p, ids), insphere_of_raised_heights(p, ids));
  }
}

TEST(InspherePerturbed, IsNeverZeroForAProperTet) {
  Points points(6);
  for (int round = 0; round < 4000; ++round) {
    std::array<Vec3, 5> p;
    for (Vec3& x : p) x = points.point(round % 2 == 0 ? 2 : 5);
    if (orient3d(p[0], p[1], p[2], p[3]) == 0 || p[4] == p[0] || p[4] == p[1] || p[4] == p[2] || p[4] == p[3]) continue;
    const std::array ids{VertexId(0U), VertexId(1U), VertexId(2U), VertexId(3U), VertexId(4U)};
    ASSERT_NE(insphere_perturbed(p, ids), 0);
    ASSERT_EQ(insphere_perturbed(p, ids),
              -insphere_perturbed({p[1], p[0], p[2], p[3], p[4]}, {ids[1], ids[0], ids[2], ids[3], ids[4]}));
  }
}

TEST(Plane, OrientAndIncircleAgreeWithArbitraryPrecision) {
  Points points(7);
  for (int round = 0; round < kRounds; ++round) {
    for (int kind = 0; kind < Points::kKinds; ++kind) {
      std::array<Vec2, 4> p;
      for (Vec2& x : p) {
        const Vec3 q = points.point(kind);
        x = {q.x, q.y};
      }
      ASSERT_EQ(orient2d(p[0], p[1], p[2]), oracle::orient2d(p[0], p[1], p[2]));
      ASSERT_EQ(incircle(p[0], p[1], p[2], p[3]), oracle::incircle(p[0], p[1], p[2], p[3]));
    }
  }
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {1, 1}), 0);
}

TEST(Plane, NearlyCollinearPointsAreTold) {
  const double step = 0x1p-42;
  EXPECT_EQ(orient2d({0, 0}, {1, 1 - step}, {1 - step, 1 - 2 * step}),
            oracle::orient2d({0, 0}, {1, 1 - step}, {1 - step, 1 - 2 * step}));
  EXPECT_TRUE(collinear({0, 0, 0}, {0.25, 0.5, -0.125}, {0.5, 1, -0.25}));
  EXPECT_FALSE(collinear({0, 0, 0}, {0.25, 0.5, -0.125}, {0.5, 1, -0.25 + step}));
  EXPECT_TRUE(collinear({0, 0, 0}, {0, 0, 0}, {0.5, 1, -0.25}));
}

TEST(SegmentTriangle, TheCasesOneByOne) {
  const Vec3 a{0, 0, 0}, b{0.5, 0, 0}, c{0, 0.5, 0};
  const auto meet = [&](Vec3 p, Vec3 q) { return segment_triangle(p, q, a, b, c); };
  EXPECT_EQ(meet({0.125, 0.125, -0.5}, {0.125, 0.125, 0.5}), SegmentTriangle::crosses);
  EXPECT_EQ(meet({0.125, 0.125, 0.25}, {0.125, 0.125, 0.5}), SegmentTriangle::disjoint);
  EXPECT_EQ(meet({0.125, 0.125, 0}, {0.125, 0.125, 0.5}), SegmentTriangle::touches);  // an end in the interior
  EXPECT_EQ(meet({0.25, 0.25, -0.5}, {0.25, 0.25, 0.5}), SegmentTriangle::touches);   // through an edge
  EXPECT_EQ(meet({0, 0, -0.5}, {0, 0, 0.5}), SegmentTriangle::touches);               // through a corner
  EXPECT_EQ(meet({0.5, 0.5, -0.5}, {0.5, 0.5, 0.5}), SegmentTriangle::disjoint);
  EXPECT_EQ(meet({0.125, 0.125, 0}, {0.25, 0.125, 0}), SegmentTriangle::touches);  // inside, in the plane
  EXPECT_EQ(meet({-0.5, 0.125, 0}, {0.75, 0.125, 0}), SegmentTriangle::touches);   // right across, in the plane
  EXPECT_EQ(meet({0.5, 0, 0}, {0.75, 0, 0}), SegmentTriangle::touches);            // collinear with an edge
  EXPECT_EQ(meet({0.75, 0, 0}, {1, 0, 0}), SegmentTriangle::disjoint);
  EXPECT_EQ(meet({0.5, 0.5, 0}, {0.75, -0.25, 0}), SegmentTriangle::disjoint);
  EXPECT_EQ(segment_triangle({0.25, 0, -0.5}, {0.25, 0, 0.5}, a, b, {0.75, 0, 0}), SegmentTriangle::touches);
  EXPECT_EQ(segment_triangle({0.25, 0.25, -0.5}, {0.25, 0.25, 0.5}, a, b, {0.75, 0, 0}), SegmentTriangle::disjoint);
}

TEST(SegmentTriangle, DoesNotDependOnTheOrder) {
  Points points(8);
  for (int round = 0; round < 4000; ++round) {
    const int kind = round % 2 == 0 ? 2 : round % Points::kKinds;
    std::array<Vec3, 5> x;
    for (Vec3& y : x) y = points.point(kind);
    const SegmentTriangle answer = segment_triangle(x[0], x[1], x[2], x[3], x[4]);
    ASSERT_EQ(segment_triangle(x[1], x[0], x[2], x[3], x[4]), answer);
    ASSERT_EQ(segment_triangle(x[0], x[1], x[4], x[2], x[3]), answer);
    ASSERT_EQ(segment_triangle(x[0], x[1], x[3], x[2], x[4]), answer);
  }
}

}  // namespace
}  // namespace curvetet
