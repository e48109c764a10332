// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/background.h"

#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

Volume floatVolume(const Cell& size, const std::function<float(const Cell&)>& value) {
  Volume volume;
  volume.geometry.size = {size[0], size[1], size[2]};
  std::vector<float> voxels;
  volume.geometry.cells().forEach([&](const Cell& cell) { voxels.push_back(value(cell)); });
  volume.voxels = std::move(voxels);
  return volume;
}

float levelAt(const Background& background, const Cell& cell) {
  std::vector<float> row;
  background.alongRow(cell[1], cell[2], row);
  return row[static_cast<std::size_t>(cell[0])];
}

TEST(Background, FollowsASlowRamp) {
  const auto ramp = [](const Cell& cell) { return static_cast<float>(100 + cell[0]); };
  const Background background(floatVolume({160, 40, 40}, ramp), 1, Progress());
  const float near = levelAt(background, {40, 20, 20}), far = levelAt(background, {120, 20, 20});
  EXPECT_NEAR(far - near, 80, 17);
  EXPECT_LE(near, 140);
}

TEST(Background, AVesselThatFillsABlockDoesNotCount) {
  const auto tube = [](const Cell& cell) {
    return (cell.head<2>() - Eigen::Vector2i(56, 56)).cast<double>().norm() < 16 ? 1000.0F : 10.0F;
  };
  const Background background(floatVolume({112, 112, 64}, tube), 1, Progress());
  EXPECT_FLOAT_EQ(levelAt(background, {56, 56, 32}), 10);
}

TEST(Background, DarkVesselsTurnTheSign) {
  const Background background(floatVolume({32, 32, 32}, [](const Cell&) { return 50.0F; }), -1,
                              Progress());
  EXPECT_FLOAT_EQ(levelAt(background, {3, 4, 5}), -50);
}

TEST(Background, MeasuresTheNoiseAndWhereItIsGreater) {
  Random random(1, 0);
  const auto noisy = [&](const Cell& cell) {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    return static_cast<float>((cell[0] < 96 ? 5 : 20) * sum);
  };
  const Background background(floatVolume({192, 64, 64}, noisy), 1, Progress());
  EXPECT_NEAR(background.noise(), 5, 0.5);
  EXPECT_NEAR(background.noiseAt({160, 32, 32}), 20, 2);
  EXPECT_NEAR(background.noiseAt({20, 32, 32}), 5, 0.5);
}

TEST(Background, WholeNumbersHaveTheNoiseOfRounding) {
  Volume volume = drawVolume(32, 1, [](const Eigen::Vector3d&) { return 5.0; });
  EXPECT_FLOAT_EQ(Background(volume, 1, Progress()).noise(),
                  static_cast<float>(1 / std::sqrt(12.0)));
}

}  // namespace
}  // namespace lumen::convert
