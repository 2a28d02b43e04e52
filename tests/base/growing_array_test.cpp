#include "base/growing_array.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace curvetet {
namespace {

/// Beside a std::vector.
TEST(GrowingArray, HoldsWhatAVectorHolds) {
  std::mt19937_64 random(1);
  GrowingArray<int> array;
  std::vector<int> vector;
  for (int k = 0; k < 3000; ++k) {
    if (k % 1000 == 500) array.reserve(vector.size() + 700);
    const int x = static_cast<int>(random());
    array.push_back(x);
    vector.push_back(x);
    ASSERT_EQ(array.size(), vector.size());
    ASSERT_GE(array.capacity(), array.size());
    ASSERT_EQ(array.back(), x);
  }
  EXPECT_TRUE(std::equal(vector.begin(), vector.end(), array.begin(), array.end()));
}

TEST(GrowingArray, AppendsAnEntryOfItsOwn) {
  GrowingArray<int> array;
  array.push_back(7);
  while (array.size() < array.capacity()) array.push_back(0);
  array.push_back(array[0]);  // it grows before the copy is stored
  EXPECT_EQ(array.back(), 7);
}

TEST(GrowingArray, IsCopiedAndMoved) {
  GrowingArray<int> array;
  for (int k = 0; k < 10; ++k) array.push_back(k);
  GrowingArray<int> copy = array;
  copy[3] = -1;
  EXPECT_EQ(array[3], 3);
  const GrowingArray<int> moved = std::move(array);
  EXPECT_EQ(moved.size(), 10U);
  EXPECT_EQ(moved[9], 9);
  copy = GrowingArray<int>();
  EXPECT_EQ(copy.size(), 0U);
}

TEST(GrowingArray, SaysWhenThereIsNoMemory) {
  GrowingArray<double> array;
  array.push_back(1);
  EXPECT_THROW(array.reserve(std::numeric_limits<std::size_t>::max() / 2), std::bad_alloc);
  EXPECT_EQ(array[0], 1);
}

}  // namespace
}  // namespace curvetet
