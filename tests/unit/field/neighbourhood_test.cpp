// SPDX-License-Identifier: Apache-2.0
#include "formats/field/neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "formats/field/radical_disc.h"
#include "tree.h"

namespace lumen::field {
namespace {

using blob::test::Tree;

TreeView viewOf(const Tree& tree) {
  const blob_model_def def = tree.definition();
  return {def.node_count, def.centre, def.radius, def.parent, def.link_count, def.link};
}

Neighbourhood neighboursIn(const Tree& tree) {
  return findNeighbourhood(viewOf(tree), findEdges(viewOf(tree)));
}

std::vector<std::uint32_t> neighboursOf(const Neighbourhood& all, std::uint32_t node) {
  return {all.node.begin() + all.offset[node], all.node.begin() + all.offset[node + 1]};
}

/// How many neighbours of a node are neither its parent nor its children.
std::size_t distantOf(const Neighbourhood& all, std::uint32_t node) {
  return static_cast<std::size_t>(std::count(all.isEdge.begin() + all.offset[node],
                                             all.isEdge.begin() + all.offset[node + 1], false));
}

/// A root with `children` children of `grandchildren` children each: nodes so thin and far apart
/// that only those two edges apart are neighbours.
Tree twoGenerations(int children, int grandchildren) {
  Tree tree;
  tree.addNode({0, 0, 0}, 0.01);
  for (int c = 0; c < children; ++c) {
    const double angle = 6.283185307179586 * c / children;
    const double x = std::cos(angle), y = std::sin(angle);
    const std::int32_t child = tree.addNode({10 * x, 10 * y, 0}, 0.01, 0);
    for (int g = 0; g < grandchildren; ++g)
      tree.addNode({20 * x, 20 * y, 3.0 * (g + 1)}, 0.01, child);
  }
  return tree;
}

// The root has 6 * 7 = 42 grandchildren; each of those has the root and 6 siblings.
TEST(Neighbourhood, ANodeHasAtMost32DistantNeighboursAlsoWhereItsPartnersHaveFew) {
  const Neighbourhood all = neighboursIn(twoGenerations(6, 7));
  EXPECT_EQ(distantOf(all, 0), 32U);
  for (std::uint32_t i = 1; i + 1 < all.offset.size(); ++i) EXPECT_LE(distantOf(all, i), 32U);
}

// 40 siblings, each of which has the 39 others two edges away.
TEST(Neighbourhood, ANodeHasAtMost32DistantNeighboursWhereAllHaveMany) {
  const Neighbourhood all = neighboursIn(twoGenerations(40, 0));
  for (std::uint32_t i = 0; i + 1 < all.offset.size(); ++i) EXPECT_LE(distantOf(all, i), 32U);
}

TEST(Neighbourhood, ANodeKeepsAllDistantNeighboursUpTo32) {
  const Neighbourhood all = neighboursIn(twoGenerations(4, 8));
  EXPECT_EQ(distantOf(all, 0), 32U);
  EXPECT_EQ(distantOf(all, 2), 8U);  // the root and seven siblings
}

TEST(Neighbourhood, EveryNeighbourHasTheNodeAsItsNeighbour) {
  for (const Tree& tree : {twoGenerations(6, 7), blob::test::bend(0.0), blob::test::fork(0.5, 0)}) {
    const Neighbourhood all = neighboursIn(tree);
    for (std::uint32_t i = 0; i + 1 < all.offset.size(); ++i)
      for (const std::uint32_t k : neighboursOf(all, i))
        EXPECT_TRUE(std::ranges::binary_search(neighboursOf(all, k), i)) << i << " and " << k;
  }
}

TEST(Neighbourhood, NodesTwoEdgesApartAreNeighboursHoweverThin) {
  Tree tree;
  for (int i = 0; i < 4; ++i) tree.addNode({1.0 * i, 0, 0}, 1e-3, i - 1);
  const Neighbourhood all = neighboursIn(tree);
  EXPECT_EQ(neighboursOf(all, 0), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(neighboursOf(all, 1), (std::vector<std::uint32_t>{0, 2, 3}));
}

/// Two nodes `distance` apart, of radius 1 and 2.
Tree twoNodes(double distance) {
  Tree tree;
  tree.addNode({0, 0, 0}, 1.0);
  tree.addNode({0, distance, 0}, 2.0, 0);
  return tree;
}

TEST(BlendingWidth, IsSixTenthsOfTheSquareOfAnEdge) {
  EXPECT_DOUBLE_EQ(blendingWidth(viewOf(twoNodes(0.5)), 0, 1, true, 0.25), 0.6 * 0.25);
}

TEST(BlendingWidth, IsHalfTheSquareBetweenDistantNodesThatAreClose) {
  EXPECT_DOUBLE_EQ(blendingWidth(viewOf(twoNodes(0.5)), 0, 1, false, 10.0), 0.5 * 0.25);
}

TEST(BlendingWidth, IsThatOfTheSpacingBetweenDistantNodesThatAreFarApart) {
  EXPECT_DOUBLE_EQ(blendingWidth(viewOf(twoNodes(4.0)), 0, 1, false, 0.3), 0.6 * 0.3);
}

TEST(BlendingWidth, IsAThousandthOfTheLesserRadiusSquaredInOnePlace) {
  EXPECT_DOUBLE_EQ(blendingWidth(viewOf(twoNodes(0.0)), 0, 1, true, 0.0), 1e-3);
  EXPECT_DOUBLE_EQ(blendingWidth(viewOf(twoNodes(0.0)), 1, 0, true, 0.0), 1e-3);
}

/// Nodes of radius 2 and 1 whose powers are equal in the plane x = 2, and a third one between them.
Tree withNodeBetween(double radius) {
  Tree tree;
  tree.addNode({0, 0, 0}, 2.0);
  tree.addNode({3, 0, 0}, 1.0, 0);
  tree.addNode({1, 0, 0}, radius, 0);
  return tree;
}

/// Whether the third node has the least power all over the plane between the two others.
bool isCutAway(double radius, std::uint32_t a, std::uint32_t b) {
  const Tree tree = withNodeBetween(radius);
  RadicalDisc disc(viewOf(tree), a, b);
  disc.cut(viewOf(tree), 2, 0.0);
  return disc.isEmpty();
}

// Its power at x = 2 is 1 - radius^2, where those of the two are 0.
TEST(RadicalDisc, LiesWhereTheTwoPowersAreEqual) {
  for (const auto& [a, b] : {std::pair{0U, 1U}, std::pair{1U, 0U}}) {
    EXPECT_FALSE(isCutAway(0.9, a, b)) << a;
    EXPECT_TRUE(isCutAway(1.1, a, b)) << a;
  }
}

TEST(RadicalDisc, OfNodesOutOfReachIsEmpty) {
  EXPECT_FALSE(RadicalDisc(viewOf(twoNodes(5.4)), 0, 1).isEmpty());
  EXPECT_TRUE(RadicalDisc(viewOf(twoNodes(5.5)), 0, 1).isEmpty());
}

TEST(RadicalDisc, InOnePlaceIsEverywhereForEqualRadiiOnly) {
  EXPECT_TRUE(RadicalDisc(viewOf(twoNodes(0.0)), 0, 1).isEmpty());
  Tree equal = twoNodes(0.0);
  equal.radius[1] = equal.radius[0];
  EXPECT_FALSE(RadicalDisc(viewOf(equal), 0, 1).isEmpty());
}

TEST(Spacing, IsTheGreatestSquareOfANodesEdges) {
  Tree tree;
  tree.addNode({0, 0, 0}, 1.0);
  tree.addNode({1, 0, 0}, 1.0, 0);
  tree.addNode({1, 0, 3}, 1.0, 1);
  const TreeView view = viewOf(tree);
  EXPECT_EQ(measureSpacings(view, findEdges(view)), (std::vector<double>{1, 9, 9}));
}

TEST(Lenders, OfTwoNodesEquallyNearTheLowerOneLends) {
  Tree tree;
  for (int i = 0; i < 3; ++i) tree.addNode({1.0 * i, 0, 0}, 1.0, i - 1);
  const std::uint32_t offset[] = {0, 1, 1, 2};
  EXPECT_EQ(findLenders(findEdges(viewOf(tree)), offset), (std::vector<std::uint32_t>{0, 0, 2}));
}

}  // namespace
}  // namespace lumen::field
