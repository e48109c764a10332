// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/settled_labels.h"

#include <variant>

#include <gtest/gtest.h>

namespace lumen::convert {
namespace {

template <class T>
Volume map(std::vector<T> voxels) {
  Volume volume;
  volume.geometry.size = {static_cast<int>(voxels.size()), 1, 1};
  volume.voxels = std::move(voxels);
  return volume;
}

using Floats = std::vector<float>;
using Shorts = std::vector<std::int16_t>;

TEST(SettledLabels, FloatsBesideWholeNumbersAreRounded) {
  const auto settled = settleLabels(map(Floats{0, 0.99999994F, 2.0000002F, 3.0009F, -0.0001F}), {});
  ASSERT_TRUE(settled);
  EXPECT_EQ(std::get<Floats>(settled->voxels.voxels), (Floats{0, 1, 2, 3, 0}));
  EXPECT_EQ(settled->remarks.size(), 1U);
}

TEST(SettledLabels, OtherFloatsAndMapsThatAreWholeStay) {
  EXPECT_FALSE(settleLabels(map(Floats{0, 1, 2.002F}), {}));
  EXPECT_FALSE(settleLabels(map(Floats{0, 1, 2, 3e7F}), {}));
  EXPECT_FALSE(settleLabels(map(Shorts{0, 1, 2}), {}));
  EXPECT_FALSE(settleLabels(map(Shorts{0, -3, -1, 2}), {}));  // grey values
}

TEST(SettledLabels, ABackgroundBelowZeroIsZero) {
  const auto alone = settleLabels(map(Shorts{-1, -1, 1, 2}), {});
  ASSERT_TRUE(alone);
  EXPECT_EQ(std::get<Shorts>(alone->voxels.voxels), (Shorts{0, 0, 1, 2}));
  const auto ignored = settleLabels(map(Shorts{0, -1, 1, 2}), {});
  ASSERT_TRUE(ignored);
  EXPECT_EQ(std::get<Shorts>(ignored->voxels.voxels), (Shorts{0, 0, 1, 2}));
  const auto far = settleLabels(map(Floats{-1024, 1, 2}), {});
  ASSERT_TRUE(far);
  EXPECT_EQ(std::get<Floats>(far->voxels.voxels), (Floats{0, 1, 2}));
  EXPECT_FALSE(settleLabels(map(Shorts{0, -2, 1}), {}));    // a label of its own
  EXPECT_FALSE(settleLabels(map(Shorts{-1, 1, 2}), {-1}));  // chosen
}

}  // namespace
}  // namespace lumen::convert
