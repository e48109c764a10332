// SPDX-License-Identifier: Apache-2.0
// Walls and nodes that are changed by hand, on beads along x whose wall points lie at y + 1 and z + 1.
#include "converters/stages/editing/wall_edits.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/stages/editing/edit.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::Case;
using formats::Vec3f;
using formats::test::addBeads;
using formats::test::alongX;

/// "a" has nodes 0 to 10 at x = 0, 0.5, ..., "b" 11 to 13 on its node 4, and "c", 14 to 24, is a tree
/// of its own in the very place of "a".
Case beads() {
  Case value = formats::test::noBeads();
  addBeads(value, "a", alongX(0, 0.5F, 11), 1);
  addBeads(value, "b", alongX(2.25F, 0.5F, 3, 0.5F), 1, 4);
  addBeads(value, "c", alongX(0, 0.5F, 11), 1);
  value.points.emplace().offset.push_back(0);
  for (const Vec3f& c : value.tree.centre) {
    value.points->position.push_back({c.x, c.y + 1, c.z});
    value.points->position.push_back({c.x, c.y, c.z + 1});
    value.points->offset.push_back(static_cast<std::uint32_t>(value.points->position.size()));
  }
  return value;
}

Vec3f pointOf(const Case& value, std::uint32_t node, std::uint32_t number) {
  return value.points->position[value.points->offset[node] + number];
}

/// The sentence of the error, after which the case must be as it was.
template <class Edit>
std::string refusal(const Edit& edit, Case value = beads()) {
  const Case before = value;
  try {
    edit(value);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_EQ(value, before);
    return error.what();
  }
  ADD_FAILURE() << "it was done";
  return {};
}

TEST(WidenAround, ScalesRadiiAndWallsAndFadesAlongTheVessel) {
  Case value = beads();
  const Change change = widenAround(value, 5, 2, 1);
  const auto factor = [](double away) { return 1 + std::pow(1 - away * away, 2); };
  EXPECT_EQ(value.tree.radius[5], 2.0F);
  EXPECT_FLOAT_EQ(value.tree.radius[4], static_cast<float>(factor(0.5)));
  EXPECT_FLOAT_EQ(value.tree.radius[6], static_cast<float>(factor(0.5)));
  EXPECT_EQ(value.tree.radius[3], 1.0F);
  EXPECT_EQ(pointOf(value, 5, 0), (Vec3f{2.5F, 2, 0}));
  EXPECT_FLOAT_EQ(pointOf(value, 6, 1).z, static_cast<float>(factor(0.5)));
  EXPECT_EQ(pointOf(value, 7, 0), (Vec3f{3.5F, 1, 0}));
  const auto edited = formats::readEditedWalls(value);
  EXPECT_TRUE(edited[4] && edited[5] && edited[6]);
  EXPECT_FALSE(edited[3] || edited[7] || edited[19]);
  EXPECT_EQ(value.tree.radius[11], 1.0F);  // of another branch
  EXPECT_FALSE(change.stale.empty());
  EXPECT_TRUE(formats::validate(value));
}

TEST(WidenAround, MovesPointsByTheirOwnPlaceAlongTheVessel) {
  Case value = beads();
  value.points->position[2 * 5] = {2.75F, 1, 0};
  widenAround(value, 5, 2, 1);
  EXPECT_FLOAT_EQ(pointOf(value, 5, 0).y, static_cast<float>(1 + std::pow(1 - 0.0625, 2)));
  EXPECT_EQ(pointOf(value, 5, 0).x, 2.75F);
}

TEST(WidenAround, BlowsUpASacFromItsCentres) {
  Case value = beads();
  value.tree.branches[0].kind = formats::BranchKind::Aneurysm;
  value.points->position[2 * 5] = {3.0F, 0.5F, 0};
  widenAround(value, 5, 2, 0.25);
  EXPECT_EQ(pointOf(value, 5, 0), (Vec3f{3.5F, 1, 0}));
}

TEST(WidenAround, RefusesLengthsThatAreNone) {
  for (const double bad : {0.0, -1.0, std::nan(""), 1e30}) {
    EXPECT_NE(refusal([&](Case& c) { widenAround(c, 5, bad, 1); }).find("lengths above 0"),
              std::string::npos);
    EXPECT_NE(refusal([&](Case& c) { widenAround(c, 5, 1, bad); }).find("lengths above 0"),
              std::string::npos);
  }
  refusal([](Case& c) { widenAround(c, 25, 1, 1); });
}

TEST(PushWall, MovesWhatTheBrushHoldsAndTheRadiusWithIt) {
  Case value = beads();
  pushWall(value, 5, {{2.5, 1, 0}, {0, 0.5, 0}, 0.6});
  EXPECT_EQ(pointOf(value, 5, 0), (Vec3f{2.5F, 1.5F, 0}));
  EXPECT_EQ(pointOf(value, 5, 1), (Vec3f{2.5F, 0, 1}));
  const double weight = std::pow(1 - std::pow(0.5 / 0.6, 2), 2);
  EXPECT_NEAR(pointOf(value, 4, 0).y, 1 + 0.5 * weight, 1e-6);
  EXPECT_FLOAT_EQ(value.tree.radius[5], 1.25F);
  EXPECT_TRUE(formats::readEditedWalls(value)[5]);
  EXPECT_FALSE(formats::readEditedWalls(value)[8]);
}

TEST(PushWall, LeavesAVesselInTheSamePlaceThatHangsTogetherNowhere) {
  Case value = beads();
  pushWall(value, 5, {{2.5, 1, 0}, {0, 0.5, 0}, 2});
  const Case before = beads();
  for (std::uint32_t node = 14; node < 25; ++node) {
    EXPECT_EQ(pointOf(value, node, 0), pointOf(before, node, 0));
    EXPECT_EQ(value.tree.radius[node], 1.0F);
  }
}

TEST(PushWall, KeepsTheWallAroundItsAxis) {
  Case value = beads();
  pushWall(value, 5, {{2.5, 1, 0}, {0, -5, 0}, 0.4});
  EXPECT_FLOAT_EQ(pointOf(value, 5, 0).y, 0.25F);
}

TEST(PushWall, RefusesABrushThatHoldsNothing) {
  const auto push = [](const Stroke& stroke) {
    return refusal([&](Case& c) { pushWall(c, 5, stroke); });
  };
  EXPECT_NE(push({{2.5, 4, 0}, {0, 1, 0}, 0.6}).find("no wall point"), std::string::npos);
  EXPECT_NE(push({{2.5, 1, 0}, {0, 1, 0}, 0}).find("radius above 0"), std::string::npos);
  push({{2.5, 1, 0}, {0, std::nan(""), 0}, 1});
  push({{std::nan(""), 1, 0}, {0, 1, 0}, 1});
  Case bare = beads();
  bare.points.reset();
  refusal([](Case& c) { pushWall(c, 5, {{2.5, 1, 0}, {0, 1, 0}, 1}); }, bare);
}

TEST(AddNode, StandsHalfwayAndTakesThePointsThere) {
  Case value = beads();
  value.points->position[2 * 5].x = 2.7F;
  const Change change = addNodeBehind(value, 5);
  ASSERT_EQ(value.tree.nodeCount(), 26U);
  EXPECT_EQ(value.tree.centre[6], (Vec3f{2.75F, 0, 0}));
  EXPECT_EQ(value.tree.parent[6], 5);
  EXPECT_EQ(value.tree.parent[7], 6);
  EXPECT_EQ(change.before[6], kNewNode);
  EXPECT_EQ(value.points->offset[7] - value.points->offset[6], 1U);
  EXPECT_EQ(pointOf(value, 6, 0).x, 2.7F);
  EXPECT_EQ(value.points->position.size(), beads().points->position.size());
  EXPECT_EQ(formats::readNodeOrigins(value)[6], formats::NodeOrigin::Measured);
  EXPECT_TRUE(formats::validate(value));
}

TEST(AddNode, WithoutPointsThereIsBridged) {
  Case value = beads();
  addNodeBehind(value, 5);
  EXPECT_EQ(formats::readNodeOrigins(value)[6], formats::NodeOrigin::Bridged);
}

TEST(AddNode, NeedsANodeBehindIt) {
  EXPECT_NE(refusal([](Case& c) { addNodeBehind(c, 10); }).find("the last of its vessel"),
            std::string::npos);
}

TEST(DeleteNode, LeavesItsPointsAndBranchesToItsNeighbours) {
  Case value = beads();
  deleteNode(value, 4);
  ASSERT_EQ(value.tree.nodeCount(), 24U);
  EXPECT_EQ(value.tree.centre[4], (Vec3f{2.5F, 0, 0}));
  EXPECT_EQ(value.tree.branches[1].parentNode, 3);
  EXPECT_EQ(value.points->position.size(), beads().points->position.size());
  EXPECT_TRUE(formats::validate(value));
  deleteNode(value, 0);
  EXPECT_EQ(value.tree.centre[0], (Vec3f{0.5F, 0, 0}));
}

TEST(DeleteNode, RefusesTheOnlyOneAndOneThatClosesALoop) {
  Case value = beads();
  value.tree.links = {{2, 8}};
  EXPECT_NE(refusal([](Case& c) { deleteNode(c, 8); }, value).find("closes a loop"),
            std::string::npos);
  Case one = formats::test::noBeads();
  addBeads(one, "a", alongX(0, 1, 2), 1);
  deleteNode(one, 0);
  EXPECT_NE(refusal([](Case& c) { deleteNode(c, 0); }, one).find("the only one"),
            std::string::npos);
}

TEST(EditedWalls, StayWithTheirNodesAndGoWithTheLast) {
  Case value = beads();
  widenAround(value, 5, 2, 0.4);
  deleteNode(value, 0);
  EXPECT_TRUE(formats::readEditedWalls(value)[4]);
  addNodeBehind(value, 1);
  EXPECT_TRUE(formats::readEditedWalls(value)[5]);
  EXPECT_EQ(value.metadata.extensionsUsed.back(), formats::kEditExtension);
  deleteNode(value, 5);
  for (const bool edited : formats::readEditedWalls(value)) EXPECT_FALSE(edited);
  EXPECT_EQ(std::count(value.metadata.extensionsUsed.begin(), value.metadata.extensionsUsed.end(),
                       formats::kEditExtension),
            0);
}

}  // namespace
}  // namespace lumen::convert
