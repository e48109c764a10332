// SPDX-License-Identifier: Apache-2.0
// The fit's speed and accuracy on synthetic vessels. One item is one node.
#include <string>

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "converters/stages/fitting/error_of_fit.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/fitting/levenberg_marquardt.h"
#include "shapes.h"

namespace {

using namespace lumen;

constexpr double kVoxel = 0.2;

/// Arguments: nodes, threads, noise in micrometres.
void fitTree(benchmark::State& state) {
  const auto nodes = static_cast<std::size_t>(state.range(0));
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  formats::Case value = test::manyNodes(nodes, 1e-3 * static_cast<double>(state.range(2)));
  Progress progress;
  for (auto _ : state) convert::fit(value, {}, progress);
  const auto count = static_cast<double>(value.tree.nodeCount());
  const auto error = convert::summariseErrorOfFit(convert::errorOfFit(value, 2, progress));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(nodes));
  state.counters["points_per_node"] = static_cast<double>(value.points->position.size()) / count;
  state.counters["blobs_per_node"] = static_cast<double>(value.models->width.size()) / count;
  state.counters["error_median_voxels"] = error.median / kVoxel;
  state.counters["error_max_voxels"] = error.max / kVoxel;
}
BENCHMARK(fitTree)
    ->Args({1000, 1, 50})
    ->Args({2000, 1, 50})
    ->Args({4000, 1, 50})
    ->Args({4000, 2, 50})
    ->Args({1000, 1, 0})
    ->Args({1000, 1, 100})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

/// The wall's distance from the true one, two nodes and more from the ends. Arguments: radius and
/// noise in micrometres.
void fitShape(benchmark::State& state, const std::string& name) {
  test::TrackingOptions options;
  options.noise = 1e-3 * static_cast<double>(state.range(1));
  test::TrackedShape tracked =
      test::trackShape(name, 1e-3 * static_cast<double>(state.range(0)), options);
  Progress progress;
  for (auto _ : state) convert::fit(tracked.value, {}, progress);
  const auto count = static_cast<double>(tracked.value.tree.nodeCount());
  const auto distances = test::wallDistances(tracked, 2);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
  state.counters["blobs_per_node"] =
      static_cast<double>(tracked.value.models->width.size()) / count;
  state.counters["wall_median_voxels"] = test::percentile(distances, 0.5) / kVoxel;
  state.counters["wall_p90_voxels"] = test::percentile(distances, 0.9) / kVoxel;
  state.counters["wall_max_voxels"] = test::percentile(distances, 1) / kVoxel;
}
#define LUMEN_FIT_SHAPE(shape)                              \
  BENCHMARK_CAPTURE(fitShape, shape, #shape)                \
      ->ArgsProduct({{300, 500, 1000, 2000}, {0, 50, 100}}) \
      ->Unit(benchmark::kMillisecond)                       \
      ->Iterations(1)
LUMEN_FIT_SHAPE(tube);
LUMEN_FIT_SHAPE(bend);
LUMEN_FIT_SHAPE(bifurcation);
LUMEN_FIT_SHAPE(capsule);

/// One evaluation of the Jacobian and one product J^T J: the fit's inner loops. Arguments: points,
/// blobs. One item is one point of one blob.
void lineariseTube(benchmark::State& state) {
  const formats::Case tube = test::trackShape("tube", 1, {0.05}).value;
  std::vector<formats::Vec3d> points;
  for (std::int64_t k = 0; k < state.range(0); ++k) {
    const auto& p = tube.points->position[static_cast<std::size_t>(k)];
    points.push_back({p.x, p.y, p.z});
  }
  std::vector<convert::fitting::Blob> blobs;
  const auto count = static_cast<std::size_t>(state.range(1));
  for (std::size_t j = 0; j < count; ++j)
    blobs.push_back({0.3 * static_cast<double>(j), 0, 0, 0.4});
  convert::fitting::Energy energy({});
  energy.setPoints(points);
  std::vector<double> a(16 * count * count), b(4 * count);
  for (auto _ : state) {
    benchmark::DoNotOptimize(energy.linearise(blobs));
    if (state.range(2) != 0) energy.normalEquations(blobs, a, b);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(1));
}
BENCHMARK(lineariseTube)
    ->Args({512, 3, 0})
    ->Args({512, 3, 1})
    ->Args({512, 6, 0})
    ->Args({512, 6, 1})
    ->Args({512, 24, 1});

}  // namespace
