// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/picture/volume_behind.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Noise with a few bright voxels, turned and with three spacings.
Volume noisy(std::array<int, 3> size) {
  Volume volume;
  volume.geometry.size = size;
  volume.geometry.spacing = {0.5, 0.7, 1.1};
  volume.geometry.origin = {3, -2, 5};
  volume.geometry.direction =
      Eigen::AngleAxisd(0.4, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  std::mt19937 random(7);
  std::vector<std::int16_t> voxels(volume.geometry.voxelCount());
  for (auto& v : voxels)
    v = static_cast<std::int16_t>(random() % (random() % 200 == 0 ? 2000 : 100)) - 50;
  volume.voxels = voxels;
  return volume;
}

double voxelAt(const Volume& volume, int i, int j, int k) {
  const auto& size = volume.geometry.size;
  const auto& voxels = std::get<std::vector<std::int16_t>>(volume.voxels);
  return voxels[static_cast<std::size_t>(i + size[0] * (j + size[1] * k))];
}

double trilinear(const Volume& volume, const Vector3d& index) {
  double sum = 0;
  std::array<int, 3> below{};
  std::array<double, 3> share{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int last = volume.geometry.size[a] - 1;
    const double inside = std::clamp(index[static_cast<Eigen::Index>(a)], 0.0, double(last));
    below[a] = static_cast<int>(inside);
    share[a] = inside - below[a];
  }
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    std::array<int, 3> at = below;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool isNext = (c >> a & 1) != 0;
      weight *= isNext ? share[a] : 1 - share[a];
      at[a] = std::min(below[a] + isNext, volume.geometry.size[a] - 1);
    }
    sum += weight * voxelAt(volume, at[0], at[1], at[2]);
  }
  return sum;
}

Camera obliqueOn(const Volume& volume) {
  Camera camera;
  camera.width = 60;
  camera.height = 50;
  camera.scale = 3;
  const auto& size = volume.geometry.size;
  camera.centre = volume.geometry.worldFromIndex(0.5 * Vector3d(size[0], size[1], size[2]));
  camera.axes = Eigen::AngleAxisd(1.1, Vector3d(0.2, -1, 0.5).normalized()).toRotationMatrix();
  return camera;
}

/// Every sample of a ray, one after the other.
float reference(const Volume& volume, const Camera& camera, int x, int y) {
  const VolumeGeometry& geometry = volume.geometry;
  double greatest = -INFINITY;
  for (int t = -400; t <= 400; ++t) {
    const Vector3d index =
        geometry.indexFromWorld(camera.place(x + 0.5, y + 0.5, t * geometry.spacing.minCoeff()));
    bool isIn = true;
    for (Eigen::Index a = 0; a < 3; ++a)
      isIn =
          isIn && index[a] >= -0.5 && index[a] <= geometry.size[static_cast<std::size_t>(a)] - 0.5;
    if (isIn) greatest = std::max(greatest, trilinear(volume, index));
  }
  return static_cast<float>(greatest);
}

class ProjectorSizes : public ::testing::TestWithParam<std::array<int, 3>> {};

TEST_P(ProjectorSizes, TakesTheGreatestSampleOfEachRay) {
  const Volume volume = noisy(GetParam());
  const Camera camera = obliqueOn(volume);
  Progress progress;
  const std::vector<float> values = Projector(volume, progress).greatest(camera, progress);
  int met = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const float value = values[static_cast<std::size_t>(y * camera.width + x)];
      const float expected = reference(volume, camera, x, y);
      if (!std::isfinite(expected)) {
        ASSERT_EQ(value, expected) << x << " " << y;
        continue;
      }
      ++met;
      ASSERT_NEAR(value, expected, 1e-3) << x << " " << y;
    }
  EXPECT_GT(met, 100);
}

INSTANTIATE_TEST_SUITE_P(Voxels, ProjectorSizes,
                         ::testing::Values(std::array{33, 17, 9}, std::array{8, 24, 16},
                                           std::array{40, 30, 1}, std::array{1, 20, 30}));

TEST(Projector, AnyNumberOfThreadsGivesTheSameBits) {
  const Volume volume = noisy({33, 17, 20});
  Progress progress;
  const auto many = Projector(volume, progress).greatest(obliqueOn(volume), progress);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = Projector(volume, progress).greatest(obliqueOn(volume), progress);
  EXPECT_EQ(std::memcmp(many.data(), single.data(), many.size() * sizeof(float)), 0);
}

TEST(GreyWindow, IsFromTheMedianToTheHighestThousandth) {
  std::vector<float> values(1001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  values.push_back(-INFINITY);
  const GreyWindow window = chooseWindow(values);
  EXPECT_EQ(window.black, 500);
  EXPECT_EQ(window.white, 999);
  EXPECT_LT(chooseWindow({5, 5, 5}).black, chooseWindow({5, 5, 5}).white);
  const Picture picture = greyPicture({-INFINITY, 400, 2000}, 3, 1, window);
  EXPECT_EQ(picture.pixels[0], (Rgb{0, 0, 0}));
  EXPECT_EQ(picture.pixels[1], (Rgb{0, 0, 0}));
  EXPECT_EQ(picture.pixels[2], (Rgb{190, 190, 190}));
}

}  // namespace
}  // namespace lumen::convert
