// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/circle_of_willis.h"

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

TEST(CircleOfWillis, AVariantHasNoWrongName) {
  const std::vector<std::set<std::string>> variants = {
      {"Acom"},         {"L-Pcom"},       {"L-A1"},
      {"R-A1"},         {"L-P1"},         {"R-P1"},
      {"L-A1", "R-P1"}, {"L-P1", "R-P1"}, {"L-Pcom", "R-Pcom"},
      {"L-A1", "R-A1"}};
  for (const auto& missing : variants) {
    double wrong = 1;
    const auto shares = rightShares(circleWithout(missing), wrong);
    EXPECT_LT(wrong, 0.001) << *missing.begin();
    if (missing.contains("L-A1") && missing.contains("R-A1")) continue;
    // the side with an A1 has its carotid artery
    const std::string side = missing.contains("L-A1") ? "R-" : "L-";
    EXPECT_GT(shares.at(side + "ICA"), 0.99) << *missing.begin();
    EXPECT_GT(shares.at(side + "MCA"), 0.99) << *missing.begin();
  }
}

TEST(CircleOfWillis, WhatOneA1AloneFeedsBeyondTheMidlineHasNoName) {
  double wrong = 1;
  const auto shares = rightShares(circleWithout({"L-A1"}), wrong);
  EXPECT_LT(shares.at("R-ACA"), 0.5);
  EXPECT_GT(shares.at("R-ACA"), 0.1);
  EXPECT_EQ(shares.at("L-ACA"), 0);
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
