// What building and insertion are made of: the curve that points are sorted along, four spheres at once, marks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>
#include <vector>

#include "base/hilbert.h"
#include "geometry/frame.h"
#include "predicates/predicates.h"
#include "spatial/insphere_four.h"
#include "spatial/small_marks.h"

namespace curvetet::kernel {
namespace {

TEST(SmallMarks, AgreeWithAMap) {
  std::mt19937 random(3);
  SmallMarks marks;
  for (int round = 0; round < 50; ++round) {
    marks.start();
    std::map<std::uint32_t, std::uint32_t> expected;
    std::uniform_int_distribution<std::uint32_t> id(0, round % 2 == 0 ? 60 : 4000000000U), state(1, 3);
    for (int k = 0; k < 40 * round; ++k) {
      const std::uint32_t at = id(random);
      EXPECT_EQ(marks.state(at), expected.contains(at) ? expected[at] : 0);
      marks.set(at, expected[at] = state(random));
    }
    for (const auto& [at, value] : expected) ASSERT_EQ(marks.state(at), value);
  }
}

TEST(Hilbert, GoesThroughEveryCellByStepsToANeighbour) {
  for (const int bits : {1, 2, 4}) {
    const std::uint32_t side = 1U << bits;
    std::vector<std::array<std::uint32_t, 3>> cells(std::size_t{1} << (3 * bits), {side, side, side});
    for (std::uint32_t x = 0; x < side; ++x)
      for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t z = 0; z < side; ++z) cells.at(hilbert_index({x, y, z}, bits)) = {x, y, z};
    for (std::size_t k = 1; k < cells.size(); ++k) {
      int away = 0;
      for (std::size_t i = 0; i < 3; ++i)
        away += std::abs(static_cast<int>(cells[k][i]) - static_cast<int>(cells[k - 1][i]));
      EXPECT_EQ(away, 1) << bits << " bits, step " << k;
    }
    for (const auto& cell : cells) EXPECT_LT(cell[0], side) << "a cell is missed";
  }
}

/// Sixteen corners of four tets, and a point; `spread` in steps of the grid.
std::vector<Site> random_sites(std::mt19937& random, int spread) {
  std::uniform_int_distribution<int> step(-spread, spread);
  std::vector<Site> sites(17);
  for (Site& site : sites) {
    site.position = {0x1p-42 * step(random), 0x1p-42 * step(random), 0x1p-42 * step(random)};
    site.id = VertexId(1);  // not read as a coordinate, though it lies beside them
  }
  return sites;
}

TEST(InsphereFour, KnowsNothingWrong) {
  std::mt19937 random(7);
  std::size_t known = 0, tied = 0, known_tied = 0;
  for (int run = 0; run < 4000; ++run) {
    const std::vector<Site> sites = random_sites(random, run % 2 == 0 ? 2 : 1 << 29);
    std::array<Corners, 4> tets;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t j = 0; j < 4; ++j) tets[k][j] = VertexId(4 * k + j);
    const Vec3 p = sites[16].position;
    const double exact = run % 4 < 2 ? 0 : exact_below(kGrid);
    const Verdicts fast = insphere_four()(sites.data(), tets[0], tets[1], tets[2], tets[3], p, exact);
    const Verdicts plain = plain_insphere_four()(sites.data(), tets[0], tets[1], tets[2], tets[3], p, exact);
    EXPECT_EQ(fast.known, plain.known);
    EXPECT_EQ(fast.known & fast.inside, plain.known & plain.inside);
    EXPECT_EQ(fast.known & fast.on, plain.known & plain.on);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at = [&](std::size_t j) { return sites[4 * k + j].position; };
      const int sign = rungs::insphere_exact(at(0), at(1), at(2), at(3), p);
      tied += sign == 0;
      if ((plain.known >> k & 1U) == 0) continue;
      ++known;
      known_tied += sign == 0;
      EXPECT_EQ(sign, (plain.on >> k & 1U) != 0 ? 0 : (plain.inside >> k & 1U) != 0 ? 1 : -1);
    }
  }
  EXPECT_GT(tied, 100U);
  EXPECT_GT(known_tied, tied / 3) << "small numbers are exact, if it is said";
  EXPECT_GT(known, 12000U) << "of 16000, most of the tied apart";
}

}  // namespace
}  // namespace curvetet::kernel
