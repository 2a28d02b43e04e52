// Against a search of all boxes.
#include "base/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace curvetet {
namespace {

TEST(BoxTree, AgreesWithSearchingAll) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  for (const std::size_t n : {0U, 1U, 5U, 300U}) {
    std::vector<Box3> boxes(n);
    std::vector<Vec3> centres;
    for (Box3& box : boxes) {
      centres.push_back(point());
      box.extend(centres.back());
      box.extend(centres.back() + 0.1 * point());
    }
    const BoxTree tree(boxes);
    for (int i = 0; i < 50; ++i) {
      Box3 query;
      query.extend(point());
      query.extend(point());
      std::vector<std::uint32_t> found, expected;
      tree.overlaps(query, found);
      std::sort(found.begin(), found.end());
      std::uint32_t nearest = UINT32_MAX;
      const Vec3 p = point();
      for (std::uint32_t j = 0; j < n; ++j) {
        bool meet = true;
        for (int k = 0; k < 3; ++k) {
          meet = meet && boxes[j].low[k] <= query.high[k] && query.low[k] <= boxes[j].high[k];
        }
        if (meet) expected.push_back(j);
        if (nearest == UINT32_MAX || norm2(centres[j] - p) < norm2(centres[nearest] - p)) nearest = j;
      }
      EXPECT_EQ(found, expected);
      EXPECT_EQ(tree.nearest(p, [&](std::uint32_t j) { return norm2(centres[j] - p); }), nearest);
    }
  }
}

TEST(BoxTree, ListsEveryItemOnce) {
  std::vector<Box3> boxes(100);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].extend({static_cast<double>(i * 37 % 100), 0, 0});
  std::vector<std::uint32_t> items = BoxTree(boxes).items();
  std::sort(items.begin(), items.end());
  for (std::uint32_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(items[i], i);
}

}  // namespace
}  // namespace curvetet
