// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/bspline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "fixtures.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

template <class T>
Volume noise(std::array<int, 3> size, double range) {
  Random random(7);
  return makeVolume<T>(size, [&](int, int, int) { return std::floor(random.uniform(0, range)); });
}

double voxelAt(const Volume& volume, int i, int j, int k) {
  const auto& size = volume.geometry.size;
  const auto at = static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
  return std::visit([at](const auto& v) { return static_cast<double>(v[at]); }, volume.voxels);
}

double largestVoxelError(const Volume& volume) {
  const BsplineVolume spline(volume);
  double worst = 0;
  const auto& size = volume.geometry.size;
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i) {
        const double error = spline.sample(Vector3d(i, j, k)) - voxelAt(volume, i, j, k);
        worst = std::max(worst, std::isnan(error) ? 1e300 : std::abs(error));
      }
  return worst;
}

/// The whole volume's coefficients by the recursive filter (Unser 1999), in double, mirrored at the
/// ends.
class Reference {
public:
  explicit Reference(const Volume& volume) : m_size(volume.geometry.size) {
    for (int k = 0; k < m_size[2]; ++k)
      for (int j = 0; j < m_size[1]; ++j)
        for (int i = 0; i < m_size[0]; ++i) m_c.push_back(voxelAt(volume, i, j, k));
    const std::array<std::size_t, 3> stride{1, extent(0), extent(0) * extent(1)};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t start = 0; start < m_c.size(); ++start)
        if (start / stride[a] % extent(a) == 0) filter(start, stride[a], extent(a));
  }

  [[nodiscard]] double at(const Vector3d& p) const {
    double sum = 0;
    std::array<int, 3> base{};
    for (int a = 0; a < 3; ++a)
      base[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(p[a]));
    for (int k = -1; k <= 2; ++k)
      for (int j = -1; j <= 2; ++j)
        for (int i = -1; i <= 2; ++i)
          sum += kernel(p[0] - base[0] - i) * kernel(p[1] - base[1] - j) *
                 kernel(p[2] - base[2] - k) *
                 m_c[(index(base[2] + k, 2) * extent(1) + index(base[1] + j, 1)) * extent(0) +
                     index(base[0] + i, 0)];
    return sum;
  }

private:
  [[nodiscard]] std::size_t extent(std::size_t a) const {
    return static_cast<std::size_t>(m_size[a]);
  }
  [[nodiscard]] std::size_t index(int i, std::size_t a) const {
    const int n = m_size[a];
    if (n == 1) return 0;
    while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;
    return static_cast<std::size_t>(i);
  }
  static double kernel(double x) {
    x = std::abs(x);
    if (x >= 2) return 0;
    return x >= 1 ? (2 - x) * (2 - x) * (2 - x) / 6 : 2.0 / 3 - x * x * (1 - x / 2);
  }
  void filter(std::size_t start, std::size_t stride, std::size_t n) {
    if (n == 1) return;
    const double z = std::sqrt(3.0) - 2;
    const auto c = [&](std::size_t i) -> double& { return m_c[start + i * stride]; };
    // the causal filter's first value: the geometric series over one period of the mirrored signal
    const std::size_t period = 2 * (n - 1);
    double first = 0;
    for (std::size_t i = 0; i < period; ++i)
      first += std::pow(z, static_cast<double>(i)) * c(i < n ? i : period - i);
    c(0) = first / (1 - std::pow(z, static_cast<double>(period)));
    for (std::size_t i = 1; i < n; ++i) c(i) += z * c(i - 1);
    c(n - 1) = z / (z * z - 1) * (c(n - 1) + z * c(n - 2));
    for (std::size_t i = n - 1; i-- > 0;) c(i) = z * (c(i + 1) - c(i));
    for (std::size_t i = 0; i < n; ++i) c(i) *= 6;
  }

  std::array<int, 3> m_size;
  std::vector<double> m_c;
};

Vector3d randomPoint(Random& random, const std::array<int, 3>& size) {
  return {random.uniform(0, size[0] - 1), random.uniform(0, size[1] - 1),
          random.uniform(0, size[2] - 1)};
}

double largestReferenceError(const Volume& volume, int points) {
  const BsplineVolume spline(volume);
  const Reference reference(volume);
  Random random(3);
  double worst = 0;
  for (int n = 0; n < points; ++n) {
    const Vector3d p = randomPoint(random, volume.geometry.size);
    const double error = spline.sample(p) - reference.at(p);
    worst = std::max(worst, std::isnan(error) ? 1e300 : std::abs(error));
  }
  return worst;
}

TEST(Bspline, InterpolatesUint8Voxels) {
  EXPECT_LT(largestVoxelError(noise<std::uint8_t>({37, 20, 9}, 256)), 256e-6);
}

TEST(Bspline, InterpolatesInt16Voxels) {
  auto volume = makeVolume<std::int16_t>({9, 37, 20}, [](int i, int j, int k) {
    return (i * 7919 + j * 104729 + k * 1299709) % 65536 - 32768;
  });
  EXPECT_LT(largestVoxelError(volume), 65536e-6);
}

TEST(Bspline, InterpolatesUint16Voxels) {
  EXPECT_LT(largestVoxelError(noise<std::uint16_t>({20, 9, 37}, 65536)), 65536e-6);
}

TEST(Bspline, InterpolatesFloatVoxels) {
  EXPECT_LT(largestVoxelError(noise<float>({36, 11, 12}, 1000)), 1000e-6);
}

TEST(Bspline, KeepsAConstant) {
  const Volume volume = makeVolume<std::uint8_t>({40, 5, 6}, [](int, int, int) { return 100; });
  const BsplineVolume spline(volume);
  EXPECT_NEAR(spline.sample({33.3, 2.7, 4.9}), 100, 1e-4);
}

TEST(Bspline, KeepsARampAwayFromTheFaces) {
  const Volume volume =
      makeVolume<std::int16_t>({48, 48, 48}, [](int i, int j, int k) { return 3 * i - 2 * j + k; });
  const BsplineVolume spline(volume);
  EXPECT_NEAR(spline.sample({20.25, 24.5, 23.75}), 3 * 20.25 - 2 * 24.5 + 23.75, 1e-4);
  EXPECT_NEAR(spline.sample({31.9, 32.1, 31.5}), 3 * 31.9 - 2 * 32.1 + 31.5, 1e-4);
}

TEST(Bspline, KeepsACubicPolynomialAwayFromTheFaces) {
  const auto cubic = [](double x) { return (x - 24) * (x - 20) * (x - 28) / 64; };
  const Volume volume = makeVolume<float>(
      {48, 48, 48}, [&](int i, int j, int k) { return cubic(i) + cubic(j) - cubic(k); });
  const BsplineVolume spline(volume);
  EXPECT_NEAR(spline.sample({22.3, 25.6, 23.5}), cubic(22.3) + cubic(25.6) - cubic(23.5), 1e-3);
}

TEST(Bspline, IsFlatAcrossTheMirroredFaces) {
  const Volume volume = noise<float>({12, 12, 12}, 100);
  const BsplineVolume spline(volume);
  // the mirrored signal is even about voxel 0, so its derivative vanishes there: a step h changes
  // O(h^2)
  const double h = 1e-3;
  EXPECT_NEAR(spline.sample({h, 5, 5}), spline.sample({0, 5, 5}), 1000 * h * h);
  EXPECT_NEAR(spline.sample({5, 5, 11 - h}), spline.sample({5, 5, 11}), 1000 * h * h);
}

TEST(Bspline, EqualsTheWholeVolumeFilterAcrossBricks) {
  EXPECT_LT(largestReferenceError(noise<float>({70, 67, 35}, 1000), 20000), 1000 * 2e-6);
}

TEST(Bspline, EqualsTheWholeVolumeFilterInThinVolumes) {
  for (const std::array<int, 3> size :
       {std::array{1, 1, 1}, std::array{2, 2, 2}, std::array{3, 3, 3}, std::array{1, 2, 40},
        std::array{33, 1, 3}, std::array{34, 2, 1}, std::array{4, 65, 2}})
    EXPECT_LT(largestReferenceError(noise<float>(size, 1000), 500), 1000 * 2e-6)
        << size[0] << " x " << size[1] << " x " << size[2];
}

TEST(Bspline, HasNoJumpAtASeam) {
  const Volume volume = noise<float>({70, 40, 40}, 1000);
  const BsplineVolume spline(volume);
  const double below = std::nextafter(32.0, 0.0);  // the last position served by the first brick
  EXPECT_NEAR(spline.sample({below, 31.5, 20}), spline.sample({32, 31.5, 20}), 1e-3);
}

TEST(Bspline, GivesNanOutsideTheVoxelCentres) {
  const Volume volume = noise<std::uint8_t>({10, 11, 12}, 256);
  const BsplineVolume spline(volume);
  EXPECT_FALSE(std::isnan(spline.sample({0, 0, 0})));
  EXPECT_FALSE(std::isnan(spline.sample({9, 10, 11})));
  EXPECT_TRUE(std::isnan(spline.sample({-1e-9, 5, 5})));
  EXPECT_TRUE(std::isnan(spline.sample({5, 5, 11.001})));
  EXPECT_TRUE(std::isnan(spline.sample({5, std::nan(""), 5})));
  EXPECT_TRUE(std::isnan(spline.sample({std::numeric_limits<double>::infinity(), 5, 5})));
}

TEST(Bspline, GivesNanOnTheOutsidePartOfALine) {
  const Volume volume = noise<std::uint8_t>({10, 10, 10}, 256);
  const BsplineVolume spline(volume);
  std::vector<float> out(100);
  spline.sampleLine({-2, 5, 5}, {0.25, 0, 0}, out);
  for (std::size_t n = 0; n < out.size(); ++n)
    EXPECT_EQ(std::isnan(out[n]), n < 8 || n > 44)
        << n;  // inside from 0 = -2 + 8/4 to 9 = -2 + 44/4
}

TEST(Bspline, SurvivesALineOfHugeNumbers) {
  const Volume volume = noise<std::uint8_t>({10, 10, 10}, 256);
  const BsplineVolume spline(volume);
  std::vector<float> out(70, 0.0F);
  spline.sampleLine({1e300, -1e300, std::nan("")}, {1e300, 1, 1}, out);
  EXPECT_TRUE(std::all_of(out.begin(), out.end(), [](float v) { return std::isnan(v); }));
  EXPECT_EQ(spline.coefficientBytes(), 0U);
}

TEST(Bspline, LineEqualsItsReference) {
  const Volume volume = noise<std::int16_t>({70, 66, 40}, 2000);
  const BsplineVolume spline(volume);
  Random random(11);
  for (int line = 0; line < 200; ++line) {
    const Vector3d from = randomPoint(random, volume.geometry.size);
    const Vector3d to = randomPoint(random, volume.geometry.size) * 1.2;
    const auto count = 1 + random.below(200);
    std::vector<float> fast(count), slow(count);
    spline.sampleLine(from, (to - from) / count, fast);
    spline.sampleLineReference(from, (to - from) / count, slow);
    for (std::size_t n = 0; n < count; ++n) {
      ASSERT_EQ(std::isnan(fast[n]), std::isnan(slow[n]));
      if (!std::isnan(fast[n])) {
        ASSERT_NEAR(fast[n], slow[n], 2000 * 2e-6);
      }
    }
  }
}

TEST(Bspline, SampleDoesNotDependOnItsPlaceInTheLine) {
  const Volume volume = noise<std::int16_t>({40, 40, 40}, 2000);
  const BsplineVolume spline(volume);
  std::vector<float> all(150), part(20);
  spline.sampleLine({1, 2, 3}, {0.125, 0.25, 0.125}, all);
  spline.sampleLine({1 + 100 * 0.125, 2 + 100 * 0.25, 3 + 100 * 0.125}, {0.125, 0.25, 0.125}, part);
  EXPECT_EQ(std::memcmp(all.data() + 100, part.data(), part.size() * sizeof(float)), 0);
}

TEST(Bspline, GivesTheSameBitsOnEveryMachine) {
  const Volume volume = noise<std::int16_t>({40, 35, 34}, 2000);
  std::vector<float> out(1000);
  BsplineVolume(volume).sampleLine({1, 2, 3}, {0.0351, 0.0301, 0.0291}, out);
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const float v : out) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3;
  }
  // equal for every instruction set, compiler and sanitizer build
  EXPECT_EQ(hash, 0xcf651cbe55feb1a1U);
}

TEST(Bspline, BuildsOnlyTouchedBricks) {
  const Volume volume = noise<std::uint8_t>({100, 100, 100}, 256);
  const BsplineVolume spline(volume);
  EXPECT_EQ(spline.coefficientBytes(), 0U);
  (void)spline.sample({10, 10, 10});
  const std::size_t one = spline.coefficientBytes();
  EXPECT_GT(one, std::size_t{4 * 32 * 32 * 32});
  EXPECT_LT(one, std::size_t{6 * 32 * 32 * 32});
  (void)spline.sample({31.9, 31.9, 31.9});
  EXPECT_EQ(spline.coefficientBytes(), one);
  (void)spline.sample({32.1, 31.9, 31.9});
  EXPECT_EQ(spline.coefficientBytes(), 2 * one);
}

TEST(Bspline, ThreadsAgreeBitwiseOnColdBricks) {
  const Volume volume = noise<std::int16_t>({100, 70, 40}, 2000);
  const auto sampleAll = [](const BsplineVolume& spline, std::vector<float>& out) {
    Random random(5);
    for (std::size_t at = 0; at + 50 <= out.size(); at += 50)
      spline.sampleLine(randomPoint(random, spline.geometry().size), {0.3, 0.2, 0.1},
                        std::span(out).subspan(at, 50));
  };
  std::vector<float> alone(5000);
  sampleAll(BsplineVolume(volume), alone);

  const BsplineVolume shared(volume);
  std::vector<std::vector<float>> together(4, std::vector<float>(5000));
  std::vector<std::thread> threads;
  for (auto& out : together) threads.emplace_back([&] { sampleAll(shared, out); });
  for (auto& thread : threads) thread.join();
  for (const auto& out : together)
    EXPECT_EQ(std::memcmp(out.data(), alone.data(), alone.size() * sizeof(float)), 0);
}

}  // namespace
}  // namespace lumen::convert
