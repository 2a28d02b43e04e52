// Topology alone: no coordinates anywhere.
#include "mesh/tet_complex.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace curvetet {
namespace {

constexpr VertexId kA{0}, kB{1}, kC{2}, kD{3}, kE{4};

/// Two tets glued at the facet (a,b,c).
struct Pair {
  TetComplex complex;
  TetId upper, lower;
  Pair() {
    upper = complex.add({kA, kB, kC, kD});
    lower = complex.add({kB, kA, kC, kE});
    complex.glue({upper, 3}, {lower, 3});
  }
};

TEST(Tables, AreEvenPermutationsAndOppositeEdges) {
  for (int i = 0; i < 4; ++i) {
    const auto& f = kFacet[static_cast<std::size_t>(i)];
    const std::array<int, 4> order{f[0], f[1], f[2], i};
    int inversions = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = j + 1; k < 4; ++k) inversions += order[j] > order[k] ? 1 : 0;
    }
    EXPECT_EQ(inversions % 2, 0);
  }
  for (std::size_t e = 0; e < 6; ++e) {
    const int all = kEdge[e][0] + kEdge[e][1] + kEdge[5 - e][0] + kEdge[5 - e][1];
    EXPECT_EQ(all, 6);
    EXPECT_NE(kEdge[e][0], kEdge[5 - e][0]);
    EXPECT_NE(kEdge[e][1], kEdge[5 - e][1]);
  }
}

TEST(TetComplex, MirrorIsAnInvolution) {
  const Pair pair;
  const TetFacet f{pair.upper, 3};
  EXPECT_EQ(pair.complex.mirror(f), (TetFacet{pair.lower, 3}));
  EXPECT_EQ(pair.complex.mirror(pair.complex.mirror(f)), f);
}

TEST(TetComplex, RecyclesSlotsClean) {
  TetComplex complex;
  const TetId first = complex.add({kA, kB, kC, kD});
  complex.set_region(first, 7);
  complex.set_mark(first, 0, true);
  complex.set_neighbour(first, 2, first);
  complex.remove(first);
  EXPECT_FALSE(complex.is_alive(first));
  EXPECT_EQ(complex.alive(), 0U);
  const TetId second = complex.add({kA, kB, kC, kE});
  EXPECT_EQ(second, first);
  EXPECT_EQ(complex.slots(), 1U);
  EXPECT_EQ(complex.region(second), 0U);
  EXPECT_FALSE(complex.mark(second, 0));
  EXPECT_FALSE(complex.neighbour(second, 2).valid());
  complex.remove(second);
  EXPECT_THROW(complex.remove(second), InternalError);
}

TEST(TetComplex, LocksAreOnBothSidesAndKeepTheirFace) {
  Pair pair;
  TetComplex& complex = pair.complex;
  complex.lock({pair.upper, 3}, FaceId(12));
  EXPECT_TRUE(complex.is_locked({pair.lower, 3}));
  EXPECT_EQ(complex.locked_face({pair.upper, 3}), FaceId(12));
  EXPECT_EQ(complex.locked_face({pair.lower, 3}), FaceId(12));
  EXPECT_FALSE(complex.locked_face({pair.lower, 0}).valid());
  EXPECT_EQ(complex.locked_count(), 1U);
  complex.lock({pair.lower, 3}, FaceId(13));
  EXPECT_EQ(complex.locked_face({pair.upper, 3}), FaceId(13));
  EXPECT_EQ(complex.locked_count(), 1U);
  complex.unlock({pair.lower, 3});
  EXPECT_FALSE(complex.is_locked({pair.upper, 3}));
  EXPECT_EQ(complex.locked_count(), 0U);
}

TEST(TetComplex, FlagsDoNotDisturbEachOther) {
  Pair pair;
  TetComplex& complex = pair.complex;
  complex.set_region(pair.upper, 0xABCDEF);
  complex.set_mark(pair.upper, 1, true);
  complex.lock({pair.upper, 3}, FaceId(1));
  EXPECT_EQ(complex.region(pair.upper), 0xABCDEFU);
  EXPECT_TRUE(complex.mark(pair.upper, 1));
  EXPECT_FALSE(complex.mark(pair.upper, 0));
  complex.set_region(pair.upper, 3);
  complex.set_mark(pair.upper, 1, false);
  EXPECT_TRUE(complex.is_locked({pair.upper, 3}));
  EXPECT_EQ(complex.region(pair.upper), 3U);
}

}  // namespace
}  // namespace curvetet
