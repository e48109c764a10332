// SPDX-License-Identifier: Apache-2.0
// Maps choose among the branches of a case, and an inventory states what it has of each label.
#include "converters/operations/label_maps.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/operations/label_inventory.h"

namespace lumen::operations {
namespace {

using convert::LabelRole;
using Names = std::vector<std::string>;

convert::VolumeGeometry mapGrid() {
  convert::VolumeGeometry geometry;
  geometry.size = {60, 21, 21};
  return geometry;
}

convert::LabelMeaning meaning(std::int64_t value, const std::string& name, LabelRole role) {
  convert::LabelMeaning made;
  made.value = value;
  made.name = name;
  made.role = role;
  made.isStated = true;
  return made;
}

/// Bars along x of 5 x 5 voxels of 1 mm, around y = z = 10 and around y = 4.
LabelPart map() {
  LabelPart part;
  part.name = "map";
  part.voxels.geometry = mapGrid();
  std::vector<std::uint8_t> labels;
  mapGrid().cells().forEach([&](const convert::Cell& cell) {
    const bool isMiddle = cell[1] >= 8 && cell[1] <= 12 && cell[2] >= 8 && cell[2] <= 12;
    const bool isSide = cell[1] >= 2 && cell[1] <= 6 && cell[2] >= 8 && cell[2] <= 12;
    std::uint8_t label = 0;
    if (isMiddle) label = cell[0] < 20 ? 1 : cell[0] >= 50 ? 3 : 0;
    if (isSide) label = cell[0] < 10 ? 2 : 4;
    labels.push_back(label);
  });
  part.voxels.voxels = std::move(labels);
  part.meanings = {meaning(1, "trunk", LabelRole::Artery), meaning(2, "twig", LabelRole::Vein),
                   meaning(3, "far", LabelRole::Vessel), meaning(4, "rib", LabelRole::Bone)};
  return part;
}

/// Appends a branch along x at a y, nodes 1 mm apart, of radius 2 mm, at z = 10.
void addBranch(formats::Case& value, const std::string& label, int from, int to, float y,
               std::int32_t parent = formats::kNoParent,
               formats::BranchKind kind = formats::BranchKind::Vessel) {
  formats::CenterlineTree& tree = value.tree;
  formats::Branch branch;
  branch.label = label;
  branch.kind = kind;
  branch.parentNode = parent;
  branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
  branch.nodeCount = static_cast<std::uint32_t>(to - from + 1);
  for (int x = from; x <= to; ++x) {
    tree.parent.push_back(x == from ? parent : static_cast<std::int32_t>(tree.nodeCount()) - 1);
    tree.centre.push_back({static_cast<float>(x), y, 10});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(2);
    tree.height.push_back(1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
  }
  tree.branches.push_back(branch);
}

Names namesIn(const formats::Case& value) {
  Names names;
  for (const formats::Branch& branch : value.tree.branches) names.push_back(branch.label);
  return names;
}

class LabelMapsTest : public testing::Test {
protected:
  [[nodiscard]] LabelInventory inventory(const formats::Case& value,
                                         const ImageBesideMaps* image = nullptr) const {
    return inventoryOf(m_maps, m_naming, value, mapGrid(), image, m_context);
  }

  Progress m_progress;
  Context m_context{m_progress};
  std::vector<LabelPart> m_maps{map()};
  std::vector<NamingMap> m_naming = namingMaps(m_maps, mapGrid(), "volume");
};

TEST_F(LabelMapsTest, OnlyLabelledVesselsAndThoseThatLeadToThemStay) {
  formats::Case value;
  addBranch(value, "root", 30, 40, 16);        // leads to a label
  addBranch(value, "trunk", 0, 19, 10, 10);    // on a label
  addBranch(value, "beyond", 20, 28, 10, 30);  // only the volume shows it
  addBranch(value, "bulge", 21, 22, 13, 20, formats::BranchKind::Aneurysm);
  addBranch(value, "sac", 24, 25, 13, 35, formats::BranchKind::Aneurysm);
  addBranch(value, "other", 30, 45, 19);
  leaveOutUnlabelled(m_naming, value, "volume");
  EXPECT_EQ(namesIn(value), (Names{"root", "trunk", "bulge"}));
}

TEST_F(LabelMapsTest, NothingOnALabelIsAFailure) {
  formats::Case value;
  addBranch(value, "other", 30, 45, 19);
  try {
    leaveOutUnlabelled(m_naming, value, "head.nrrd");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Failed);
    EXPECT_STREQ(error.what(),
                 "head.nrrd: no vessel that is found in it lies on a label of a "
                 "vessel; nothing is written");
  }
}

TEST_F(LabelMapsTest, RemarksOnEndsFollowTheirBranches) {
  formats::Case value;
  addBranch(value, "trunk", 0, 19, 10);
  std::vector<convert::TrackEnd> ends(2);
  ends[0].position = {19, 10, 10};
  ends[0].label = "vessel-1";
  ends[1].position = {19, 10, 12};
  renameEnds(value.tree, ends);
  ASSERT_EQ(ends.size(), 1U);
  EXPECT_EQ(ends[0].label, "trunk");
}

TEST_F(LabelMapsTest, TheInventoryMeasuresTheVesselsOfALabel) {
  formats::Case value;
  addBranch(value, "trunk", 3, 26, 10);
  value.tree.radius[0] = 3;
  addBranch(value, "bare", 40, 45, 19);
  const LabelInventory made = inventory(value);
  ASSERT_EQ(made.maps.size(), 1U);
  ASSERT_EQ(made.maps[0].labels.size(), 4U);
  const MappedLabel& trunk = made.maps[0].labels[0];
  EXPECT_EQ(trunk.voxels, 500U);
  EXPECT_EQ(trunk.branches, Names{"trunk"});
  EXPECT_NEAR(trunk.length, 23, 1e-5);
  EXPECT_NEAR(trunk.leastRadius, 2, 1e-6);
  EXPECT_NEAR(trunk.meanRadius, 2 + 1.0 / 24, 1e-6);
  EXPECT_NEAR(trunk.greatestRadius, 3, 1e-6);
  ASSERT_EQ(trunk.beyond.size(), 1U);
  EXPECT_FALSE(trunk.beyond[0].isStart);
  EXPECT_NEAR(trunk.beyond[0].length, 7, 1e-5);  // from 19 to 26
  // of 25 voxels of a slice the four corners lie more than half a voxel outside of 2 mm
  EXPECT_GT(trunk.heldShare, 0.8);
  EXPECT_LT(trunk.heldShare, 0.95);
  EXPECT_EQ(made.unlabelled, Names{"bare"});
  EXPECT_NEAR(made.unlabelledLength, 5, 1e-5);
}

TEST_F(LabelMapsTest, ALabelWithoutABranchStatesTheReason) {
  formats::Case value;
  addBranch(value, "trunk", 0, 19, 10);
  addBranch(value, "long", 20, 59, 10);
  value.tree.radius[59] = 2;
  addBranch(value, "short", 55, 56, 10);
  // the far label takes a quarter of "long", which is wider than that
  for (std::size_t n = 20; n < 60; ++n) value.tree.radius[n] = 6;
  const LabelInventory made = inventory(value);
  EXPECT_EQ(made.maps[0].labels[2].missing, "");  // "short" is named by it
  formats::Case without;
  addBranch(without, "trunk", 0, 19, 10);
  EXPECT_EQ(inventory(without).maps[0].labels[2].missing, "no cylinder fits along it");
  addBranch(without, "long", 20, 59, 10);
  for (std::size_t n = 20; n < 60; ++n) without.tree.radius[n] = 6;
  EXPECT_EQ(inventory(without).maps[0].labels[2].missing, "its voxels lie in long");
  EXPECT_EQ(inventory(without).maps[0].labels[3].missing, "");  // a rib is no vessel
}

TEST_F(LabelMapsTest, LabelsOfNoVesselStateTheVolumeThatTheyTookAway) {
  formats::Case value;
  addBranch(value, "trunk", 0, 19, 10);
  convert::Volume volume;
  volume.geometry = mapGrid();
  std::vector<std::int16_t> voxels;
  convert::Prior prior;
  mapGrid().cells().forEach([&](const convert::Cell& cell) {
    const bool isRib = cell[1] >= 2 && cell[1] <= 6 && cell[2] >= 8 && cell[2] <= 12 && cell[0] > 9;
    const bool isBright = isRib ? cell[0] < 30 : cell[1] >= 8 && cell[1] <= 12 && cell[0] < 20;
    voxels.push_back(isBright ? 300 : 20);
    prior.systems.push_back(isRib ? convert::Prior::kNoVessel : convert::Prior::kNothing);
  });
  volume.voxels = std::move(voxels);
  const ImageBesideMaps image{volume, prior};
  const LabelInventory made = inventory(value, &image);
  EXPECT_NEAR(made.maps[0].labels[3].refused, 20 * 25, 1e-9);
  EXPECT_EQ(made.maps[0].labels[2].missing,
            "most of its voxels are outside of the levels of the vessels that are found");
  EXPECT_FALSE(made.maps[0].labels[3].leftOut);  // no vessel
  EXPECT_FALSE(inventory(value).maps[0].labels[0].leftOut);
}

TEST_F(LabelMapsTest, WhatACaseLacksOfALabelIsStatedByReason) {
  formats::Case value;
  addBranch(value, "trunk", 0, 19, 10);
  convert::Volume volume;
  volume.geometry = mapGrid();
  std::vector<std::int16_t> voxels;
  convert::Prior prior;
  std::array<double, kLeftOutCount> far{};
  mapGrid().cells().forEach([&](const convert::Cell& cell) {
    const bool isBeside = cell[1] < 9;
    voxels.push_back(cell[0] < 20 ? 300 : isBeside ? 20 : cell[2] < 10 ? 900 : 300);
    const bool isTaken = cell[0] >= 20 && cell[2] == 12;
    prior.systems.push_back(isTaken ? convert::Prior::kNoVessel : convert::Prior::kNothing);
    if (m_naming[0].mask.label[mapGrid().index(cell)] != 3) return;
    const LeftOut why = isTaken        ? LeftOut::NotVessel
                        : isBeside     ? LeftOut::Faint
                        : cell[2] < 10 ? LeftOut::Strong
                                       : LeftOut::NoWall;
    ++far[static_cast<std::size_t>(why)];
  });
  volume.voxels = std::move(voxels);
  const ImageBesideMaps image{volume, prior};
  const std::vector<MappedLabel> labels = inventory(value, &image).maps[0].labels;
  ASSERT_TRUE(labels[2].leftOut);
  for (std::size_t why = 0; why < kLeftOutCount; ++why) {
    EXPECT_GT(far[why], 0) << why;
    EXPECT_NEAR((*labels[2].leftOut)[why], far[why], 1e-9) << why;
  }
  // a trunk is as bright as itself, and what lies beyond its wall has none
  ASSERT_TRUE(labels[0].leftOut);
  EXPECT_NEAR(labels[0].leftOut->back(), (1 - labels[0].heldShare) * 500, 1e-6);
  EXPECT_NEAR(labels[0].leftOut->front(), 0, 1e-9);
}

}  // namespace
}  // namespace lumen::operations
