// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/insertion.h"

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "tests/unit/export/made_tree.h"

namespace lumen::convert {

namespace {

using formats::BranchKind;
using formats::CenterlineTree;

/// A trunk along z of 20 mm that goes on in a wide branch of 9 mm; a thin one and a sac hang on it.
CenterlineTree fork() {
  CenterlineTree tree;
  addBranch(tree, "trunk", -1, {0, 0, 0}, {0, 0, 1}, 21, 2);
  addBranch(tree, "thin", 20, {1, 0, 20}, {1, 0, 0}, 30, 0.3F);
  addBranch(tree, "wide", 20, {0, 0, 21}, {0, 0, 1}, 9, 1.5F);
  addBranch(tree, "sac", 20, {0, 5, 20}, {0, 1, 0}, 3, 5, BranchKind::Aneurysm);
  return tree;
}

TEST(Insertion, LiesAsFarInsideTheRootAsItNeedsAndFollowsTheWidestVessel) {
  const Insertion in = findInsertion(fork(), "", 1.5);
  EXPECT_EQ(in.branch, 0U);
  EXPECT_EQ(in.position, Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(in.direction, Eigen::Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(in.radius, 2);
  // to the last node, at z = 29, less its radius
  EXPECT_DOUBLE_EQ(in.pathLength, 29 - 1.5 - 2);
}

TEST(Insertion, IsAtTheBranchThatIsNamed) {
  const Insertion in = findInsertion(fork(), "sac", 0.5);
  EXPECT_EQ(in.branch, 3U);
  EXPECT_EQ(in.position, Eigen::Vector3d(0, 6, 20));
}

TEST(Insertion, RefusesALabelThatNoBranchHasAndTellsThose) {
  try {
    findInsertion(fork(), "trunc", 0.5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_NE(std::string(error.what()).find("trunk, thin, wide, sac"), std::string::npos);
  }
}

TEST(Insertion, RefusesAVesselThatIsTooNarrow) {
  try {
    findInsertion(fork(), "thin", 0.5);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
  }
}

TEST(Insertion, TurnsTheXAxisIntoAnyDirection) {
  for (const Eigen::Vector3d& to :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(0.6, 0, -0.8)})
    EXPECT_LT((turnTo(to) * Eigen::Vector3d::UnitX() - to).norm(), 1e-12);
}

}  // namespace

}  // namespace lumen::convert
