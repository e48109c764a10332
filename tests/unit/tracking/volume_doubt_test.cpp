// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::convert {
namespace {

template <class T>
Volume volumeOf(std::vector<T> voxels) {
  Volume volume;
  volume.geometry.size = {static_cast<int>(voxels.size()), 1, 1};
  volume.voxels = std::move(voxels);
  return volume;
}

TEST(VolumeDoubt, AMaskIsNamedWithItsTwoValues) {
  const auto doubt = doubtAbout(volumeOf<std::uint8_t>({0, 0, 1, 0, 1}));
  ASSERT_TRUE(doubt);
  EXPECT_NE(doubt->find("0 or 1 only"), std::string::npos) << *doubt;
  EXPECT_TRUE(doubtAbout(volumeOf<float>({255, -1.5F, 255})));
}

TEST(VolumeDoubt, ThreeValuesAreNoMask) {
  EXPECT_FALSE(doubtAbout(volumeOf<std::int16_t>({0, 0, 1, 0, 2})));
  EXPECT_FALSE(doubtAbout(volumeOf<float>({0, 1, 0.5F})));
}

TEST(VolumeDoubt, OneValueIsRefused) {
  try {
    (void)doubtAbout(volumeOf<std::uint16_t>({7, 7, 7}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("every voxel is 7"), std::string::npos);
  }
}

}  // namespace
}  // namespace lumen::convert
