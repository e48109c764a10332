// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/label_prior.h"

#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::operations {
namespace {

using convert::LabelRole;
using convert::Prior;
using Eigen::Vector3d;

/// A map of 20 x 20 x 20 mm whose voxels have label 1 up to x = 10, and 2 behind.
LabelPart halves(double voxel, LabelRole first, LabelRole second) {
  LabelPart map;
  const int size = static_cast<int>(20 / voxel);
  map.voxels.geometry.size = {size, size, size};
  map.voxels.geometry.spacing.setConstant(voxel);
  // along -x, from its far end
  map.voxels.geometry.direction.col(0) = -Vector3d::UnitX();
  map.voxels.geometry.direction.col(1) = -Vector3d::UnitY();
  map.voxels.geometry.origin = Vector3d(20, 20, 0) - 0.5 * voxel * Vector3d(1, 1, -1);
  std::vector<std::uint8_t> labels;
  map.voxels.geometry.cells().forEach([&](const convert::Cell& cell) {
    labels.push_back(map.voxels.geometry.position(cell).x() < 10 ? 1 : 2);
  });
  map.voxels.voxels = std::move(labels);
  for (const auto& [value, role] : {std::pair{1, first}, std::pair{2, second}}) {
    convert::LabelMeaning meaning;
    meaning.value = value;
    meaning.role = role;
    meaning.isStated = true;
    map.meanings.push_back(meaning);
  }
  return map;
}

convert::VolumeGeometry grid() {
  convert::VolumeGeometry geometry;
  geometry.size = {24, 20, 20};  // 4 mm farther than the map
  geometry.origin = {0.5, 0.5, 0.5};
  return geometry;
}

std::vector<std::uint8_t> alongX(const std::vector<LabelPart>& maps) {
  const convert::VolumeGeometry geometry = grid();
  const Prior prior = priorOf(maps, geometry, Progress());
  std::vector<std::uint8_t> row;
  for (const int x : {0, 9, 10, 19, 23})
    if (!prior.systems.empty()) row.push_back(prior.systems[geometry.index({x, 7, 7})]);
  return row;
}

using Row = std::vector<std::uint8_t>;
constexpr std::uint8_t kNo = Prior::kNoVessel;

TEST(LabelPrior, IsResampledByPosition) {
  for (const double voxel : {0.5, 1.0, 2.0})
    EXPECT_EQ(alongX({halves(voxel, LabelRole::Artery, LabelRole::Vein)}), (Row{1, 1, 2, 2, 0}))
        << voxel;
}

TEST(LabelPrior, RolesAreSystemsOrNoVessel) {
  EXPECT_EQ(alongX({halves(1, LabelRole::TrueLumen, LabelRole::FalseLumen)}), (Row{1, 1, 3, 3, 0}));
  EXPECT_EQ(alongX({halves(1, LabelRole::Vessel, LabelRole::Aneurysm)}), (Row{1, 1, 1, 1, 0}));
  for (const LabelRole role : {LabelRole::Bone, LabelRole::Organ, LabelRole::Metal,
                               LabelRole::Calcium, LabelRole::Chamber})
    EXPECT_EQ(alongX({halves(1, LabelRole::Artery, role)}), (Row{1, 1, kNo, kNo, 0}));
}

TEST(LabelPrior, AGuessFromANameTakesNothingAway) {
  LabelPart map = halves(1, LabelRole::Artery, LabelRole::Bone);
  for (convert::LabelMeaning& meaning : map.meanings) meaning.isStated = false;
  EXPECT_EQ(alongX({map}), (Row{1, 1, 0, 0, 0}));
}

TEST(LabelPrior, TheFirstMapWithALumenCounts) {
  EXPECT_EQ(alongX({halves(1, LabelRole::Unknown, LabelRole::Bone),
                    halves(1, LabelRole::Vein, LabelRole::Artery),
                    halves(1, LabelRole::Bone, LabelRole::Vein)}),
            (Row{2, 2, 1, 1, 0}));
}

TEST(LabelPrior, NothingLiesOutsideOfARegion) {
  EXPECT_EQ(alongX({halves(1, LabelRole::Region, LabelRole::Unknown)}), (Row{0, 0, kNo, kNo, kNo}));
}

TEST(LabelPrior, MapsThatSayNothingLeaveNone) {
  EXPECT_TRUE(alongX({halves(1, LabelRole::Unknown, LabelRole::Unknown)}).empty());
  EXPECT_TRUE(alongX({}).empty());
}

}  // namespace
}  // namespace lumen::operations
