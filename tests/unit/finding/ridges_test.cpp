// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/stages/finding/background.h"
#include "converters/stages/finding/bright_voxels.h"
#include "tests/unit/tracking/tube_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// The strength at the voxel of a place in mm.
float at(const Volume& volume, const ZeroedArray<float>& strength, const Vector3d& place) {
  const Vector3d index = volume.geometry.indexFromWorld(place);
  return strength[volume.geometry.index(Cell(index.array().round().matrix().cast<int>()))];
}

TEST(Ridges, AThinTubeIsOneAndItsSurroundingsAreNot) {
  // across two bricks and oblique to all axes
  const Volume volume = drawVolume(80, 1, [](const Vector3d& p) {
    return capsule(p, {10, 12, 8}, {70, 66, 74}, 1.5);
  });
  const auto strength = ridgeStrength(volume, 1, Progress());
  for (const double t : {0.2, 0.5, 0.8}) {
    const Vector3d on = Vector3d(10, 12, 8) + t * Vector3d(60, 54, 66);
    EXPECT_GT(at(volume, strength, on), 120) << t;
    EXPECT_LT(at(volume, strength, on + Vector3d(8, -8, 0)), 5) << t;
  }
}

TEST(Ridges, ADarkTubeIsOneWithTheOtherSign) {
  const Volume volume = drawVolume(40, 1, [](const Vector3d& p) {
    return -capsule(p, {20, 20, 4}, {20, 20, 36}, 1.5);
  });
  EXPECT_GT(at(volume, ridgeStrength(volume, -1, Progress()), {20, 20, 20}), 120);
  EXPECT_EQ(at(volume, ridgeStrength(volume, 1, Progress()), {20, 20, 20}), 0);
}

TEST(Ridges, NeitherASheetNorABallNorTheWallOfAWideTubeIsOne) {
  const auto strengthOf = [](const std::function<double(const Vector3d&)>& distance,
                             const Vector3d& place) {
    const Volume volume = drawVolume(48, 1, distance);
    return at(volume, ridgeStrength(volume, 1, Progress()), place);
  };
  EXPECT_EQ(strengthOf([](const Vector3d& p) { return std::abs(p.x() - 24) - 1.5; }, {24, 24, 24}),
            0);
  EXPECT_EQ(strengthOf([](const Vector3d& p) { return (p - Vector3d(24, 24, 24)).norm() - 2; },
                       {24, 24, 24}),
            0);
  EXPECT_LT(strengthOf(
                [](const Vector3d& p) {
                  return capsule(p, {24, 24, 4}, {24, 24, 44}, 9);
                },
                {34, 24, 24}),
            20);
}

/// Values on a cube of voxels, which repeat its faces beyond them.
struct Cube {
  int edge = 0;
  std::vector<double> value;

  [[nodiscard]] double at(const Cell& cell) const {
    const Cell inside = cell.cwiseMax(0).cwiseMin(edge - 1);
    return value[static_cast<std::size_t>((inside[2] * edge + inside[1]) * edge + inside[0])];
  }
  template <class Of>
  [[nodiscard]] Cube map(const Of& of) const {
    Cube out{edge, {}};
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) out.value.push_back(of(Cell(x, y, z)));
    return out;
  }
};

/// Smoothed by a Gaussian that is cut at three standard deviations, one axis after the other.
Cube smoothed(Cube cube, double sigma) {
  for (int axis = 0; axis < 3; ++axis)
    cube = cube.map([&, before = cube](const Cell& cell) {
      double sum = 0, weights = 0;
      const int reach = static_cast<int>(std::ceil(3 * sigma));
      for (int k = -reach; k <= reach; ++k) {
        const double weight = std::exp(-0.5 * k * k / (sigma * sigma));
        sum += weight * before.at(cell + k * Cell::Unit(axis));
        weights += weight;
      }
      return sum / weights;
    });
  return cube;
}

/// The strength of a ridge by its definition; NaN where rounding may decide whether there is one.
double ridgeBy(const Eigen::Matrix3d& hessian) {
  constexpr double kRound = 0.4, kAlong = 0.5, kNear = 1e-3;
  const Vector3d c = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(hessian).eigenvalues();
  const double least = std::min({-c[1], kRound * c[0] - c[1], -kAlong * c[1] - std::abs(c[2])});
  if (std::abs(least) < kNear * hessian.norm()) return std::numeric_limits<double>::quiet_NaN();
  return least > 0 ? -c[1] : 0;
}

TEST(Ridges, OfNoiseAreThoseOfTheDefinition) {
  constexpr int kEdge = 24, kRim = 9;  // voxels that no smoothing of clamped values reaches
  const Volume drawn = drawVolume(kEdge, 1, [](const Vector3d&) { return 1.0; });
  Volume volume = drawn;
  Random random(7);
  std::vector<std::int16_t> noise;
  for (int i = 0; i < kEdge * kEdge * kEdge; ++i)
    noise.push_back(static_cast<std::int16_t>(random.uniform(-3000, 3000)));
  volume.voxels = noise;
  const Cube cube{kEdge, {noise.begin(), noise.end()}};
  const auto strength = ridgeStrength(volume, 1, Progress());
  std::vector<Cube> smooth;
  const std::vector<double> scales{1.0, 1.6, 2.5};
  for (const double sigma : scales) smooth.push_back(smoothed(cube, sigma));
  int compared = 0, ridges = 0;
  const CellBox inside = CellBox::between(Cell::Constant(kRim), Cell::Constant(kEdge - kRim - 1));
  inside.forEach([&](const Cell& cell) {
    double expected = 0;
    for (std::size_t s = 0; s < scales.size(); ++s) {
      Eigen::Matrix3d h;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const Cell p = Cell::Unit(a), q = Cell::Unit(b);
          h(a, b) = a == b
                        ? smooth[s].at(cell + p) + smooth[s].at(cell - p) - 2 * smooth[s].at(cell)
                        : (smooth[s].at(cell + p + q) + smooth[s].at(cell - p - q) -
                           smooth[s].at(cell + p - q) - smooth[s].at(cell - p + q)) /
                              4;
        }
      const double ridge = scales[s] * scales[s] * ridgeBy(h);
      if (std::isnan(ridge) || ridge > expected) expected = ridge;
      if (std::isnan(expected)) break;
    }
    if (std::isnan(expected)) return;
    const auto found = static_cast<double>(strength[volume.geometry.index(cell)]);
    EXPECT_NEAR(found, expected, 1e-3 * expected + 1e-2) << cell.transpose();
    ++compared;
    ridges += expected > 0 ? 1 : 0;
  });
  EXPECT_GT(compared, 150);
  EXPECT_GT(ridges, 30);
}

TEST(Ridges, AreTheSameInMillimetresForVoxelsOfAnySize) {
  Volume volume = drawVolume(40, 1, [](const Vector3d& p) {
    return capsule(p, {20, 20, 4}, {20, 20, 36}, 1.5);
  });
  const float before = at(volume, ridgeStrength(volume, 1, Progress()), {20, 20, 20});
  volume.geometry.spacing.setConstant(0.3);
  const float after = at(volume, ridgeStrength(volume, 1, Progress()), {6, 6, 6});
  EXPECT_NEAR(after, before, 1e-3 * before);
}

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
