// The field of given sources: against a naive minimum over all cones, and its gradation as a property.
#include "sizing/size_field.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace curvetet {
namespace {

/// Sources on a coarse lattice, so that places and sizes coincide now and then.
std::vector<SizeSource> random_sources(unsigned seed, std::size_t n) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(-20, 20), size(1, 15);
  std::vector<SizeSource> sources(n);
  for (SizeSource& source : sources) {
    source.where = {0.025 * place(random), 0.025 * place(random), 0.025 * place(random)};
    source.size = 0.02 * size(random);
  }
  return sources;
}

double naive(const std::vector<SizeSource>& sources, const SizingOptions& options, Vec3 p) {
  double best = options.size;
  for (const SizeSource& source : sources)
    best = std::min(best, source.size + options.grading * distance(p, source.where));
  return best;
}

Vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-0.7, 0.7);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

TEST(SizeField, EqualsTheNaiveMinimum) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SizingOptions options;
    options.size = 0.25;
    options.grading = std::array{0.05, 0.3, 1.0}[seed % 3];
    const auto sources = random_sources(seed, 4 * seed);
    const SizeField field(sources, options);
    std::mt19937 random(seed);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = random_point(random);
      ASSERT_NEAR(field.at(p), naive(sources, options, p), 1e-14) << "seed " << seed;
    }
  }
}

TEST(SizeField, IsGraded) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SizingOptions options;
    options.size = 0.25;
    options.grading = std::array{0.05, 0.3, 1.0}[seed % 3];
    const SizeField field(random_sources(seed, 100), options);
    std::mt19937 random(seed);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = random_point(random);
      const Vec3 q = random_point(random);
      ASSERT_GT(field.at(p), 0);
      ASSERT_LE(std::abs(field.at(p) - field.at(q)), options.grading * distance(p, q) + 1e-14) << "seed " << seed;
    }
  }
}

TEST(SizeField, WithoutSourcesIsTheLargestSize) {
  SizingOptions options;
  options.size = 0.1;
  const SizeField field({}, options);
  EXPECT_EQ(field.at({1, 2, 3}), 0.1);
  EXPECT_EQ(field.smallest(), 0.1);
}

TEST(SizeField, AddedSourcesCount) {
  SizingOptions options;
  options.size = 0.2;
  auto first = random_sources(1, 50);
  const auto second = random_sources(2, 50);
  SizeField field(first, options);
  field.add(second);
  first.insert(first.end(), second.begin(), second.end());
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = random_point(random);
    EXPECT_NEAR(field.at(p), naive(first, options, p), 1e-14);
  }
}

TEST(SizeField, FloorHoldsForDerivedSizesOnly) {
  SizingOptions options;
  options.size = 0.1;
  options.min_size = 0.01;
  SizeSource source;
  source.size = 0.001;
  source.reason = SizeReason::curvature;
  EXPECT_EQ(SizeField({source}, options).at({}), 0.01);
  source.reason = SizeReason::gap;
  EXPECT_EQ(SizeField({source}, options).at({}), 0.01);
  source.reason = SizeReason::asked;
  EXPECT_EQ(SizeField({source}, options).at({}), 0.001);
  source.reason = SizeReason::outer_loop;
  EXPECT_EQ(SizeField({source}, options).at({}), 0.001);
}

TEST(SizeField, CallbackAndEntitySizesLower) {
  SizingOptions options;
  options.size = 0.1;
  options.callback = [](Vec3 p) { return p.x > 0 ? 0.02 : 0.5; };
  options.face_size[3] = 0.05;
  options.edge_size[7] = 0.04;
  const SizeField field({}, options);
  EXPECT_EQ(field.at({1, 0, 0}), 0.02);
  EXPECT_EQ(field.at({-1, 0, 0}), 0.1);
  EXPECT_EQ(field.at_face(FaceId(3), {-1, 0, 0}), 0.05);
  EXPECT_EQ(field.at_face(FaceId(3), {1, 0, 0}), 0.02);
  EXPECT_EQ(field.at_face(FaceId(4), {-1, 0, 0}), 0.1);
  EXPECT_EQ(field.at_edge(EdgeId(7), {-1, 0, 0}), 0.04);
  EXPECT_EQ(field.smallest(), 0.04);
}

TEST(SizeField, ManySourcesAtOnePlace) {
  SizingOptions options;
  options.size = 1;
  std::vector<SizeSource> sources(1000);
  for (std::size_t i = 0; i < sources.size(); ++i) sources[i].size = 0.001 * static_cast<double>(i + 1);
  EXPECT_EQ(SizeField(sources, options).at({}), 0.001);
}

}  // namespace
}  // namespace curvetet
