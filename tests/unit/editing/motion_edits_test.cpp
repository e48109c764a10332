// SPDX-License-Identifier: Apache-2.0
// Edits of a case with a motion, on beads along x: "a" with two that hang on it, and one on the second.
#include <gtest/gtest.h>

#include "converters/stages/editing/edit.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::Case;
using formats::test::addBeads;
using formats::test::alongX;

/// "a" has nodes 0 to 10, "b" 11 to 15 on node 10, "c" 16 to 20 on node 4, "d" 21 to 25 on node 18.
Case fourVessels() {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 11), 1);
  addBeads(value, "b", alongX(5.5F, 0.5F, 5), 1, 10);
  addBeads(value, "c", alongX(2, 0.5F, 5, 0.5F), 1, 4);
  addBeads(value, "d", alongX(3, 0.5F, 5, 1), 1, 18);
  return value;
}

// A motion of nodes 4 and 18, with centres of their own.
formats::Motion swayOf(const Case& value) {
  formats::Motion motion{{0, 1}, 0, {4, 18}, {}};
  for (int t = 0; t < 2; ++t)
    for (const std::uint32_t node : motion.node) {
      formats::Pose pose{value.tree.centre[node], {0, 0, 0, 1}, 1};
      pose.centre.z += static_cast<float>(t) + static_cast<float>(node);
      motion.pose.push_back(pose);
    }
  return motion;
}

// spec: M53
TEST(MotionEdits, KeepTheMotionOfNodesThatStayWhereTheyAre) {
  Case value = fourVessels();
  value.motion = swayOf(value);
  const formats::Motion before = *value.motion;
  const Change change = deleteBranch(value, 1, Hanging::Go);
  ASSERT_TRUE(value.motion);
  EXPECT_TRUE(change.droppedArrays.empty());
  ASSERT_EQ(value.motion->node.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(change.before[value.motion->node[n]], before.node[n]);
    EXPECT_EQ(value.motion->pose[2 + n], before.pose[2 + n]);
  }
  EXPECT_LT(value.motion->node[1], 18U);
}

// spec: M53
TEST(MotionEdits, DropTheMotionWhereNodesAreNewOrMoved) {
  Case joined = fourVessels();
  joined.motion = swayOf(joined);
  ASSERT_TRUE(cutBefore(joined, 7).droppedArrays.empty());
  EXPECT_TRUE(joined.motion);
  EXPECT_EQ(joinBranch(joined, 1, 0).droppedArrays, std::vector<std::string>{"motion"});
  EXPECT_FALSE(joined.motion);
  Case moved = fourVessels();
  moved.motion = swayOf(moved);
  moveNode(moved, 4, {2, 0.25, 0}, 1);
  EXPECT_FALSE(moved.motion);
}

}  // namespace
}  // namespace lumen::convert
