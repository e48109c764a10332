// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/stated_vessels.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/node_origin.h"
#include "formats/case/validate.h"

namespace lumen::operations {
namespace {

using formats::NodeOrigin;

convert::VolumeGeometry barGrid() {
  convert::VolumeGeometry geometry;
  geometry.size = {80, 21, 21};
  return geometry;
}

bool isInBar(const convert::Cell& cell, int from, int to) {
  const int y = cell[1] - 10, z = cell[2] - 10;
  return cell[0] >= from && cell[0] <= to && y * y + z * z <= 9;
}

/// An artery of 3 mm radius along x, from 5 to 75 mm.
LabelPart barMap() {
  LabelPart part;
  part.name = "map";
  part.voxels.geometry = barGrid();
  std::vector<std::uint8_t> labels;
  barGrid().cells().forEach(
      [&](const convert::Cell& cell) { labels.push_back(isInBar(cell, 5, 75)); });
  part.voxels.voxels = std::move(labels);
  convert::LabelMeaning artery;
  artery.value = 1;
  artery.role = convert::LabelRole::Artery;
  part.meanings = {artery};
  return part;
}

/// Lumen by level along the bar.
convert::FoundVessels lumenBetween(int from, int to) {
  convert::FoundVessels found;
  found.geometry = barGrid();
  barGrid().cells().forEach([&](const convert::Cell& cell) {
    if (isInBar(cell, from, to)) found.lumen.push_back(barGrid().index(cell));
  });
  std::sort(found.lumen.begin(), found.lumen.end());
  return found;
}

/// A case of one vessel in the bar, with nodes 1 mm apart.
formats::Case foundBetween(int from, int to) {
  formats::Case value;
  formats::CenterlineTree& tree = value.tree;
  formats::Branch branch;
  branch.label = "vessel-1";
  branch.nodeCount = static_cast<std::uint32_t>(to - from + 1);
  formats::PointSets& points = value.points.emplace();
  points.offset.push_back(0);
  for (int x = from; x <= to; ++x) {
    tree.parent.push_back(x - from - 1);
    tree.centre.push_back({static_cast<float>(x), 10, 10});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(3);
    tree.height.push_back(1);
    tree.branch.push_back(0);
    points.position.push_back({static_cast<float>(x), 13, 10});
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  tree.branches.push_back(branch);
  return value;
}

std::vector<formats::Case> bar() {
  Progress progress;
  return statedVessels({barMap()}, {progress});
}

TEST(StatedVessels, GoOnWhereTheVolumeShowsLumenButNoWall) {
  formats::Case value = foundBetween(5, 30);
  ASSERT_EQ(addStatedVessels(bar(), lumenBetween(5, 60), value), 1U);
  EXPECT_TRUE(formats::validate(value));
  const formats::Branch& added = value.tree.branches[1];
  EXPECT_EQ(added.parentNode, 25) << "the last node of what is found";
  const std::uint32_t last = added.firstNode + added.nodeCount - 1;
  EXPECT_NEAR(value.tree.centre[added.firstNode].x, 34, 2);
  EXPECT_NEAR(value.tree.centre[last].x, 59, 2) << "no farther than the lumen";
  EXPECT_NEAR(value.tree.radius[last - 2], 3, 0.3);
  const auto origins = formats::readNodeOrigins(value);
  EXPECT_EQ(origins[25], NodeOrigin::Measured);
  EXPECT_TRUE(std::all_of(origins.begin() + 26, origins.end(),
                          [](NodeOrigin origin) { return origin == NodeOrigin::Given; }));
}

TEST(StatedVessels, HangOnTheVesselThatTheyEndIn) {
  formats::Case value = foundBetween(40, 75);
  ASSERT_EQ(addStatedVessels(bar(), lumenBetween(5, 75), value), 1U);
  const formats::Branch& added = value.tree.branches[1];
  EXPECT_EQ(added.parentNode, 0);
  EXPECT_GT(value.tree.centre[added.firstNode].x,
            value.tree.centre[added.firstNode + added.nodeCount - 1].x);
}

TEST(StatedVessels, AreNoneWithoutTheLevelOfLumen) {
  formats::Case value = foundBetween(5, 30);
  EXPECT_EQ(addStatedVessels(bar(), lumenBetween(5, 30), value), 0U);
  EXPECT_EQ(value.tree.branches.size(), 1U);
}

TEST(StatedVessels, AreNoneWhereTheyAreFoundOrNoLongerThanWide) {
  formats::Case whole = foundBetween(5, 75);
  EXPECT_EQ(addStatedVessels(bar(), lumenBetween(5, 75), whole), 0U);
  formats::Case most = foundBetween(5, 70);
  EXPECT_EQ(addStatedVessels(bar(), lumenBetween(5, 75), most), 0U) << "a bump at its end";
}

TEST(StatedVessels, AreNoneOfALabelThatFillsMoreThanVesselsDo) {
  Progress progress;
  const auto countWith = [&](std::ptrdiff_t more) {  // the bar has 2059 of 35,280 voxels
    LabelPart map = barMap();
    auto& labels = std::get<std::vector<std::uint8_t>>(map.voxels.voxels);
    std::fill_n(labels.begin(), more, std::uint8_t{1});
    return statedVessels({map}, {progress}).size();
  };
  EXPECT_EQ(countWith(1200), 1U) << "9 %";
  EXPECT_EQ(countWith(1680), 0U) << "11 %";
}

TEST(StatedVessels, NeedLabelsOfVessels) {
  LabelPart rib = barMap();
  rib.meanings[0].role = convert::LabelRole::Bone;
  Progress progress;
  EXPECT_TRUE(statedVessels({rib}, {progress}).empty());
}

}  // namespace
}  // namespace lumen::operations
