// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/circle_of_willis.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "converters/stages/phantom/design.h"

namespace lumen::convert {
namespace {

using formats::CenterlineTree;

CenterlineTree circleWithout(const std::set<std::string>& missing) {
  return designWillis({0.2, 51}, missing).tree;
}

/// The share of each true artery's nodes that has its name, and in `wrong` that of nodes with the
/// name of another one.
std::map<std::string, double> rightShares(const CenterlineTree& tree, double& wrong) {
  std::vector<std::string> name(tree.nodeCount());
  for (const ArteryStretch& stretch : nameCircleOfWillis(tree)) {
    EXPECT_GE(stretch.plausibility, kLeastPlausibility);
    EXPECT_LE(stretch.plausibility, 1);
    for (std::uint32_t n = stretch.first; n < stretch.end; ++n) {
      EXPECT_EQ(tree.branch[n], stretch.branch);
      name[n] = stretch.name;
    }
  }
  std::map<std::string, double> shares;
  wrong = 0;
  for (const formats::Branch& branch : tree.branches) {
    double& share = shares[branch.label] = 0;
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
      share += name[n] == branch.label ? 1.0 / branch.nodeCount : 0;
      wrong += name[n].empty() || name[n] == branch.label ? 0 : 1.0 / double(tree.nodeCount());
    }
  }
  return shares;
}

TEST(CircleOfWillis, EachArteryOfAWholeCircleHasItsName) {
  double wrong = 1;
  const auto shares = rightShares(circleWithout({}), wrong);
  EXPECT_EQ(shares.size(), 12U);
  for (const auto& [name, share] : shares) EXPECT_GT(share, 0.99) << name;
  EXPECT_LT(wrong, 0.001);
}

TEST(CircleOfWillis, EachArteryOfAVariantHasItsName) {
  const std::vector<std::set<std::string>> variants = {
      {"Acom"},         {"L-Pcom"},        {"L-A1"},
      {"R-A1"},         {"L-P1"},          {"R-P1"},
      {"L-A1", "R-P1"}, {"L-P1", "R-P1"},  {"L-Pcom", "R-Pcom"},
      {"L-A1", "L-P1"}, {"R-A1", "R-Pcom"}};
  for (const auto& missing : variants) {
    double wrong = 1;
    const auto shares = rightShares(circleWithout(missing), wrong);
    // where one PCA leaves the basilar artery, 4 mm have no name
    for (const auto& [name, share] : shares)
      EXPECT_GT(share, 0.8) << name << " " << *missing.begin();
    EXPECT_LT(wrong, 0.003) << *missing.begin();
  }
}

TEST(CircleOfWillis, WithoutBothA1ThereIsNoName) {
  EXPECT_TRUE(nameCircleOfWillis(circleWithout({"L-A1", "R-A1"})).empty());
}

TEST(CircleOfWillis, TwoAcaThatDoNotCrossFromOneA1HaveNoSides) {
  CenterlineTree tree = circleWithout({"L-A1"});
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.branches[tree.branch[n]].label == "L-ACA")
      tree.centre[n].x -= 5;
    else if (tree.branches[tree.branch[n]].label == "Acom")
      tree.centre[n].x = 24;
  double wrong = 1;
  const auto shares = rightShares(tree, wrong);
  EXPECT_EQ(shares.at("L-ACA"), 0);
  EXPECT_LT(shares.at("R-ACA"), 0.5);
}

TEST(CircleOfWillis, ACarotidArteryThatASearchCameToFromAboveHasItsName) {
  CenterlineTree tree = circleWithout({});
  const auto is = [&](std::size_t n, const char* name) {
    return tree.branches[tree.branch[n]].label == name;
  };
  // its root is the end of the carotid artery, and its inlet a leaf
  std::uint32_t first = 0, last = 0;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    if (!is(n, "R-ICA")) continue;
    if (last == 0 && tree.parent[n] == formats::kNoParent) first = n;
    last = n;
  }
  formats::Branch& branch = tree.branches[tree.branch[first]];
  std::reverse(tree.centre.begin() + first, tree.centre.begin() + last + 1);
  std::reverse(tree.radius.begin() + first, tree.radius.begin() + last + 1);
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    if (!is(n, "R-ICA") && tree.parent[n] >= std::int32_t(first) &&
        tree.parent[n] <= std::int32_t(last))
      tree.parent[n] = std::int32_t(first + last) - tree.parent[n];
  ASSERT_EQ(branch.parentNode, formats::kNoParent);
  double wrong = 1;
  const auto shares = rightShares(tree, wrong);
  for (const auto& [name, share] : shares) EXPECT_GT(share, 0.9) << name;
  EXPECT_LT(wrong, 0.001);
}

TEST(CircleOfWillis, AMirroredCircleHasItsSidesExchanged) {
  CenterlineTree tree = circleWithout({"R-Pcom"});
  for (formats::Vec3f& centre : tree.centre) centre.x = -centre.x;
  for (formats::Branch& branch : tree.branches)
    if (branch.label[1] == '-') branch.label[0] = branch.label[0] == 'L' ? 'R' : 'L';
  double wrong = 1;
  const auto shares = rightShares(tree, wrong);
  for (const auto& [name, share] : shares) EXPECT_GT(share, 0.99) << name;
  EXPECT_LT(wrong, 0.001);
}

/// The tree with its sizes multiplied.
CenterlineTree scaled(CenterlineTree tree, float factor) {
  for (formats::Vec3f& centre : tree.centre)
    centre = {centre.x * factor, centre.y * factor, centre.z * factor};
  for (float& radius : tree.radius) radius *= factor;
  return tree;
}

TEST(CircleOfWillis, VesselsOfAnotherSizeOrPlaceHaveNoNames) {
  EXPECT_FALSE(nameCircleOfWillis(scaled(circleWithout({}), 1.1F)).empty());
  EXPECT_TRUE(nameCircleOfWillis(scaled(circleWithout({}), 2)).empty());
  EXPECT_TRUE(nameCircleOfWillis(scaled(circleWithout({}), 0.4F)).empty());
  // on its side
  CenterlineTree turned = circleWithout({});
  for (formats::Vec3f& centre : turned.centre) centre = {centre.z, centre.y, centre.x};
  EXPECT_TRUE(nameCircleOfWillis(turned).empty());
  EXPECT_TRUE(nameCircleOfWillis(designBifurcation({0.2, 51}).tree).empty());
  EXPECT_TRUE(nameCircleOfWillis({}).empty());
}

TEST(CircleOfWillis, AHeadThatLeansKeepsItsNames) {
  for (const float lean : {-0.15F, 0.15F}) {
    CenterlineTree tree = circleWithout({});
    for (formats::Vec3f& centre : tree.centre) centre.x += lean * centre.z;
    double wrong = 1;
    const auto shares = rightShares(tree, wrong);
    for (const auto& [name, share] : shares)
      EXPECT_GT(share, name == "Acom" ? -1 : 0.9) << name << " " << lean;
    EXPECT_LT(wrong, 0.005);
  }
}

}  // namespace
}  // namespace lumen::convert
