#include "spatial/small_marks.h"

#include <gtest/gtest.h>

#include <random>
#include <unordered_map>

namespace curvetet::kernel {
namespace {

/// Beside a std::unordered_map, over many starts and more ids than there is room for at first.
TEST(SmallNumbers, AreGivenInOrder) {
  std::mt19937_64 random(2);
  SmallNumbers numbers;
  for (std::size_t round = 0; round < 200; ++round) {
    numbers.start();
    std::unordered_map<std::uint32_t, std::uint32_t> map;
    for (std::size_t k = 0; k < 5 * round; ++k) {
      const auto id = static_cast<std::uint32_t>(random() % 700) * 65536U;
      ASSERT_EQ(numbers.contains(id), map.contains(id));
      map.emplace(id, static_cast<std::uint32_t>(map.size()));
      ASSERT_EQ(numbers.number_of(id), map[id]);
      ASSERT_EQ(numbers.count(), map.size());
    }
  }
}

}  // namespace
}  // namespace curvetet::kernel
