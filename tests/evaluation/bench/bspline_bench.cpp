// SPDX-License-Identifier: Apache-2.0
// Sampling as tracking does it: rays of 128 samples over three radii, from one centre, in a warm
// volume.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "converters/base/random.h"
#include "converters/voxels/bspline.h"

namespace {

using namespace lumen::convert;

constexpr int kSize = 128;
constexpr int kRays = 162;
constexpr int kSamples = 128;

const Volume& noise() {
  static const Volume volume = [] {
    Volume v;
    v.geometry.size = {kSize, kSize, kSize};
    std::vector<std::int16_t> voxels(v.geometry.voxelCount());
    lumen::Random random(1);
    for (auto& x : voxels) x = static_cast<std::int16_t>(random.below(2000));
    v.voxels = std::move(voxels);
    return v;
  }();
  return volume;
}

std::vector<Eigen::Vector3d> directions() {
  lumen::Random random(2);
  std::vector<Eigen::Vector3d> all;
  for (int r = 0; r < kRays; ++r)
    all.push_back(Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  return all;
}

using Sampler = void (BsplineVolume::*)(const Eigen::Vector3d&, const Eigen::Vector3d&,
                                        std::span<float>) const;

/// Argument: the vessel's radius in voxels. One item is one sample.
void castRays(benchmark::State& state, Sampler sampler) {
  const BsplineVolume volume(noise());
  const double step = 3.0 * static_cast<double>(state.range(0)) / kSamples;
  const auto rays = directions();
  const Eigen::Vector3d centre(61.3, 66.2, 64.4);
  std::array<float, kSamples> out{};
  for (const auto& d : rays) (volume.*sampler)(centre, step * d, out);
  for (auto _ : state)
    for (const auto& d : rays) {
      (volume.*sampler)(centre, step * d, out);
      benchmark::DoNotOptimize(out);
    }
  state.SetItemsProcessed(state.iterations() * kRays * kSamples);
}
BENCHMARK_CAPTURE(castRays, simd, &BsplineVolume::sampleLine)->Arg(2)->Arg(5)->Arg(15);
BENCHMARK_CAPTURE(castRays, reference, &BsplineVolume::sampleLineReference)->Arg(5);

/// One item is one brick of coefficients.
void buildBricks(benchmark::State& state) {
  for (auto _ : state) {
    const BsplineVolume volume(noise());
    for (int k = 0; k < kSize; k += 32)
      for (int j = 0; j < kSize; j += 32)
        for (int i = 0; i < kSize; i += 32)
          benchmark::DoNotOptimize(volume.sample({i + 0.5, j + 0.5, k + 0.5}));
  }
  state.SetItemsProcessed(state.iterations() * 64);
}
BENCHMARK(buildBricks)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
