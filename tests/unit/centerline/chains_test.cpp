// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/io/centerline/centerline_readers.h"

namespace lumen::convert {
namespace {

using Indices = std::vector<std::int32_t>;

TEST(Chains, AtAForkTheWidestChildGoesOn) {
  const CenterlineFile file = parseSwc(
      "1 0 0 0 0 2 -1\n2 0 1 0 0 2 1\n3 0 2 0 0 1 2\n4 0 1 1 0 1.5 2\n5 0 1 2 0 1.5 4\n", "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].points, (Indices{0, 1, 3, 4}));
  EXPECT_EQ(chains[1].points, Indices{2});
  EXPECT_EQ(chains[1].parent, 0);
  EXPECT_EQ(chains[1].parentSample, 1U);
}

TEST(Chains, OfEquallyWideChildrenTheOneThatTurnsLeastGoesOn) {
  const CenterlineFile file =
      parseSwc("1 0 0 0 0 2 -1\n2 0 1 0 0 2 1\n3 0 1 1 0 1 2\n4 0 2 0.1 0 1 2\n", "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 2U);
  EXPECT_EQ(chains[0].points, (Indices{0, 1, 3}));
  EXPECT_EQ(chains[1].points, Indices{2});
}

TEST(Chains, APointAtThePlaceOfItsParentIsOneWithIt) {
  // the root is there three times, and so is the point that the last one hangs on
  const CenterlineFile file = parseSwc(
      "1 0 0 0 0 2 -1\n2 0 0 0 0 2 1\n3 0 1 0 0 2 2\n4 0 1 0 0 1 3\n5 0 1 1 0 1 4\n"
      "6 0 2 0 0 2 3\n7 0 0 0 0 1 1\n8 0 -1 0 0 1 7\n",
      "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 3U);
  EXPECT_EQ(chains[0].points, (Indices{0, 2, 5}));
  EXPECT_EQ(chains[1].points, Indices{7});
  EXPECT_EQ(chains[1].parentSample, 0U);
  EXPECT_EQ(chains[2].points, Indices{4});
  EXPECT_EQ(chains[2].parentSample, 1U);
}

TEST(Chains, EveryRootBeginsATreeAndParentsComeFirst) {
  const CenterlineFile file = parseSwc(
      "1 0 0 0 0 1 -1\n2 0 9 0 0 1 -1\n3 0 1 0 0 1 1\n4 0 9 1 0 1 2\n5 0 8 0 0 0.5 2\n6 0 7 0 0 "
      "0.5 5\n7 0 8 1 0 0.4 5\n",
      "t");
  const std::vector<CenterlineChain> chains = centerlineChains(file);
  ASSERT_EQ(chains.size(), 4U);
  EXPECT_EQ(chains[0].parent, -1);
  EXPECT_EQ(chains[1].parent, -1);
  for (std::size_t c = 0; c < chains.size(); ++c)
    EXPECT_LT(chains[c].parent, static_cast<std::int32_t>(c));
  EXPECT_EQ(chains[3].points, Indices{6});
  EXPECT_EQ(chains[3].parent, 2);
}

TEST(Chains, ALoneRootIsAChainOfOnePoint) {
  const std::vector<CenterlineChain> chains = centerlineChains(parseSwc("1 0 0 0 0 1 -1\n", "t"));
  ASSERT_EQ(chains.size(), 1U);
  EXPECT_EQ(chains[0].points, Indices{0});
}

}  // namespace
}  // namespace lumen::convert
