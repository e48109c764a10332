// SPDX-License-Identifier: Apache-2.0
// Closed surfaces of random trees; tests/evaluation/reproduce/random_surfaces.cpp makes a thousand.
#include "random_trees.h"

#include <cstdint>

#include <gtest/gtest.h>

#include "closed_cases.h"

namespace lumen::convert {
namespace {

constexpr std::uint64_t kCases = 6;
constexpr std::uint64_t kEndBehindABend = 66;  // whose flat face would pass through the bend
constexpr std::uint64_t kPinchedPiece = 89;    // of which triangles at a vertex were left alone
constexpr std::uint64_t kSmallTriangle = 408;  // which rounding to floats would turn over
constexpr std::uint64_t kFolded = 673;         // in which crossings stay along the field
constexpr std::uint64_t kTakenNode = 85;       // whose first node is in the passage of another edge

TEST(RandomTrees, TouchCrossAndJump) {
  std::size_t touching = 0;
  double greatestJump = 1;
  for (std::uint64_t number = 1; number <= kCases; ++number) {
    const formats::Case source = test::randomTrees(number);
    const field::BlendedField blended = formats::caseField(source);
    const SeparatedField field(source, blended, {.gap = 0.02});
    for (std::uint32_t n = 0; n < source.tree.nodeCount(); ++n) {
      touching += field.mayTouch(n) ? 1 : 0;
      if (const std::int32_t parent = source.tree.parent[n]; parent >= 0) {
        const double ratio = double{source.tree.radius[n]} /
                             double{source.tree.radius[static_cast<std::size_t>(parent)]};
        greatestJump = std::max({greatestJump, ratio, 1 / ratio});
      }
    }
  }
  EXPECT_GT(touching, 100U);
  EXPECT_GT(greatestJump, 4);
}

TEST(RandomTrees, HaveASurfaceBeforeRemeshingThatDoesNotPassThroughItself) {
  Progress silent;
  for (std::uint64_t number = 1; number <= kCases; ++number) {
    const formats::Case source = test::randomTrees(number);
    const field::BlendedField blended = formats::caseField(source);
    const SeparatedField field(source, blended, {.gap = 0.02});
    ExtractionReport report;
    const CaseSurface surface = extractSurface(field, 1.0, report, silent);
    EXPECT_EQ(selfIntersections(surface.mesh).pairs.size(), 0U) << number;
  }
}

TEST(RandomTrees, HaveClosedSurfacesOfTheirTopology) {
  for (std::uint64_t number = 1; number <= kCases; ++number)
    EXPECT_EQ(test::faultOf(test::randomTrees(number)), "") << number;
}

TEST(RandomTrees, HaveAnEndThatStaysRoundWhereItsFaceWouldPassThroughAWall) {
  EXPECT_EQ(test::faultOf(test::randomTrees(kEndBehindABend)), "");
}

TEST(RandomTrees, HaveTheLumenOfMostNodesWhereTheFirstNodeIsInNone) {
  EXPECT_EQ(test::faultOf(test::randomTrees(kTakenNode)), "");
}

TEST(RandomTrees, HaveNoHoleWhereAPieceIsUsedAgain) {
  EXPECT_EQ(test::faultOf(test::randomTrees(kPinchedPiece)), "");
}

TEST(RandomTrees, HaveNoCrossingWhenPlacesAreRoundedAsInFiles) {
  EXPECT_EQ(test::faultOf(test::randomTrees(kSmallTriangle)), "");
}

TEST(RandomTrees, HaveNoFoldThatOnlySmoothingUndoes) {
  EXPECT_EQ(test::faultOf(test::randomTrees(kFolded)), "");
}

TEST(RandomTrees, HaveClosedSurfacesOfFewTriangles) {
  ClosedSurfaceOptions options;
  for (const SurfaceError& allowed : {SurfaceError{.radii = 0.03}, SurfaceError{.mm = 0.2}}) {
    options.maxError = allowed;
    for (const std::uint64_t number :
         {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}, kEndBehindABend, kPinchedPiece,
          kSmallTriangle, kFolded, kTakenNode})
      EXPECT_EQ(test::faultOf(test::randomTrees(number), options), "") << number;
  }
}

TEST(RandomTrees, HaveClosedSurfacesOfAGivenNumberOfTriangles) {
  ClosedSurfaceOptions options;
  options.maxTriangles = 3000;
  for (std::uint64_t number = 1; number <= kCases; ++number)
    EXPECT_EQ(test::faultOf(test::randomTrees(number), options), "") << number;
}

TEST(RandomTrees, HaveClosedWalls) {
  ClosedSurfaceOptions options;
  options.thickness = Length{0, 0.2};
  for (std::uint64_t number = 1; number <= 2; ++number)
    EXPECT_EQ(test::faultOf(test::randomTrees(number), options), "") << number;
}

}  // namespace
}  // namespace lumen::convert
