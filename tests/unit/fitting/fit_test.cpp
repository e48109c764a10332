// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/fit.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/stages/fitting/error_of_fit.h"
#include "formats/case/blobby.h"
#include "formats/case/topology.h"
#include "shapes.h"
#include "tests/evaluation/reproduce/implicit_surface.h"

namespace lumen::convert {
namespace {

using formats::Vec3d;
using test::TrackedShape;
using test::TrackingOptions;

constexpr double kVoxel = 0.2;

TrackedShape fitted(const std::string& name, double radius, double noise,
                    const FitOptions& options = {}) {
  TrackingOptions tracking;
  tracking.noise = noise;
  TrackedShape tracked = test::trackShape(name, radius, tracking);
  Progress progress;
  fit(tracked.value, options, progress);
  return tracked;
}

double blobsPerNode(const formats::Case& value) {
  return static_cast<double>(value.models->width.size()) /
         static_cast<double>(value.tree.nodeCount());
}

struct Vessel {
  const char* shape;
  double radius, noise;  // mm
};

std::string vesselName(const testing::TestParamInfo<Vessel>& tested) {
  const Vessel& v = tested.param;
  return std::string(v.shape) + std::to_string(std::lround(1000 * v.radius)) + "Noise" +
         std::to_string(std::lround(1000 * v.noise));
}

class FitOfVessel : public testing::TestWithParam<Vessel> {};

TEST_P(FitOfVessel, WallIsWithinATenthOfAVoxelWithSixBlobs) {
  const auto& [shape, radius, noise] = GetParam();
  const TrackedShape tracked = fitted(shape, radius, noise);
  const std::vector<double> distances = test::wallDistances(tracked, 2);
  ASSERT_GT(distances.size(), 300U);
  EXPECT_LE(test::percentile(distances, 0.5), 0.1 * kVoxel);
  EXPECT_LE(test::percentile(distances, 0.9), 0.35 * kVoxel);
  EXPECT_LE(blobsPerNode(tracked.value), 6);
}

INSTANTIATE_TEST_SUITE_P(Synthetic, FitOfVessel,
                         testing::Values(Vessel{"tube", 0.3, 0.025}, Vessel{"tube", 1, 0},
                                         Vessel{"tube", 1, 0.05}, Vessel{"tube", 2, 0.1},
                                         Vessel{"bend", 0.5, 0.05}, Vessel{"bend", 1, 0.1},
                                         Vessel{"bend", 2, 0.05}, Vessel{"bifurcation", 0.5, 0.05},
                                         Vessel{"bifurcation", 1, 0.05},
                                         Vessel{"bifurcation", 2, 0.1},
                                         Vessel{"capsule", 0.5, 0.05}, Vessel{"capsule", 2, 0.1}),
                         vesselName);

class FitWithKernel : public testing::TestWithParam<formats::Kernel> {};

TEST_P(FitWithKernel, WallIsWithinAQuarterOfAVoxel) {
  FitOptions options;
  options.kernel = GetParam();
  const TrackedShape tracked = fitted("bend", 1, 0.05, options);
  EXPECT_LE(test::percentile(test::wallDistances(tracked, 2), 0.5), 0.25 * kVoxel);
}

INSTANTIATE_TEST_SUITE_P(All, FitWithKernel,
                         testing::Values(formats::Kernel::Gaussian, formats::Kernel::Quartic,
                                         formats::Kernel::SoftObject),
                         [](const auto& tested) { return test::kernelName(tested.param); });

double distanceTo(const formats::Vec3f& p, const formats::Vec3d& q) {
  return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z);
}

/// How far, mm, the node's surface lies beyond the farthest point of its neighbourhood, seen from
/// the node along its direction and against it.
double overshoot(const formats::Case& value, std::uint32_t node) {
  const formats::Vec3f &c = value.tree.centre[node], &d = value.tree.direction[node];
  double farthest = 0, surface = 0;
  for (const std::uint32_t near : formats::Neighbours(value.tree).within(node, 2)) {
    for (std::uint32_t k = value.points->offset[near]; k < value.points->offset[near + 1]; ++k) {
      farthest = std::max(farthest, distanceTo(value.points->position[k], {c.x, c.y, c.z}));
    }
  }
  for (const double sign : {-1.0, 1.0}) {
    double t = 0;
    const auto inside = [&] {
      const Vec3d p{c.x + sign * t * d.x, c.y + sign * t * d.y, c.z + sign * t * d.z};
      return formats::evaluateField(*value.models, node, p).f > value.models->isoLevel;
    };
    while (t < 20 && inside()) t += 0.02;
    surface = std::max(surface, t);
  }
  return surface - farthest;
}

TEST(Fit, NarrowNoisyVesselsEndWithinTwoRadiiOfTheirPoints) {
  constexpr double kRadius = 0.25;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    TrackingOptions tracking{0.04};
    tracking.rays = 60;
    tracking.seed = seed;
    formats::Case value = test::trackShape("tube", kRadius, tracking).value;
    Progress progress;
    fit(value, {}, progress);
    for (std::uint32_t node = 0; node < value.tree.nodeCount(); ++node) {
      EXPECT_LT(overshoot(value, node), 2 * kRadius) << "seed " << seed << ", node " << node;
    }
  }
}

TEST(Fit, BlobsLieInTheLumen) {
  const formats::Case value = fitted("bifurcation", 0.3, 0.05).value;
  const formats::Neighbours neighbours(value.tree);
  for (std::uint32_t node = 0; node < value.tree.nodeCount(); ++node) {
    const auto near = neighbours.within(node, 2);
    for (std::uint32_t j = value.models->offset[node]; j < value.models->offset[node + 1]; ++j) {
      const formats::Vec3f& c = value.models->centre[j];
      EXPECT_TRUE(std::any_of(near.begin(), near.end(),
                              [&](std::uint32_t i) {
                                return distanceTo(value.tree.centre[i], {c.x, c.y, c.z}) <=
                                       1.0001 * value.tree.radius[i];
                              }))
          << "node " << node;
    }
  }
}

class SeamsOfVessel : public testing::TestWithParam<Vessel> {};

TEST_P(SeamsOfVessel, AreWithinATwentiethOfAVoxel) {
  const auto& [shape, radius, noise] = GetParam();
  Progress progress;
  const auto seams = reproduce::measureSeams(fitted(shape, radius, noise).value, progress);
  ASSERT_GT(seams.jump.size(), 300U);
  EXPECT_EQ(seams.lost, 0U);
  EXPECT_LT(reproduce::quantile(seams.jump, 0.99), 0.05 * kVoxel);
}

INSTANTIATE_TEST_SUITE_P(Synthetic, SeamsOfVessel,
                         testing::Values(Vessel{"tube", 0.3, 0.025}, Vessel{"tube", 1, 0.05},
                                         Vessel{"bend", 0.5, 0.05}, Vessel{"bend", 2, 0.1}),
                         vesselName);

TEST(Fit, SeamsOfABifurcationAreWithinATenthOfAVoxel) {
  Progress progress;
  const auto seams = reproduce::measureSeams(fitted("bifurcation", 1, 0.05).value, progress);
  EXPECT_LT(reproduce::quantile(seams.jump, 0.5), 0.01 * kVoxel);
  EXPECT_LT(reproduce::quantile(seams.jump, 0.99), 0.1 * kVoxel);
}

TEST(Fit, WithoutSweepsSeamsAreWider) {
  Progress progress;
  FitOptions alone;
  alone.seamSweeps = 0;
  const auto before = reproduce::measureSeams(fitted("bend", 1, 0.05, alone).value, progress);
  const auto after = reproduce::measureSeams(fitted("bend", 1, 0.05).value, progress);
  EXPECT_GT(reproduce::quantile(before.jump, 0.99), 3 * reproduce::quantile(after.jump, 0.99));
}

TEST(Fit, ErrorOfFitIsThatOfTheNoise) {
  const TrackedShape tracked = fitted("tube", 1, 0.05);
  Progress progress;
  const ErrorOfFitSummary error = summariseErrorOfFit(errorOfFit(tracked.value, 2, progress));
  // 90 % of normal deviates are within 1.645 standard deviations
  EXPECT_NEAR(error.median, 1.645 * 0.05, 0.01);
  EXPECT_LT(error.max, 0.15);
}

TEST(Fit, ThreadsDoNotChangeTheResult) {
  std::vector<formats::Case> results;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(fitted("bifurcation", 0.8, 0.05).value);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

formats::Case scaledBy(formats::Case value, float factor) {
  const auto scale = [factor](std::vector<formats::Vec3f>& points) {
    for (auto& p : points) p = {factor * p.x, factor * p.y, factor * p.z};
  };
  scale(value.tree.centre);
  scale(value.points->position);
  for (float& r : value.tree.radius) r *= factor;
  *value.metadata.voxelSize *= static_cast<double>(factor);
  return value;
}

TEST(Fit, AVesselEightTimesAsLargeInVoxelsEightTimesAsLargeHasTheSameModel) {
  // a power of two, so that scaling rounds nothing
  formats::Case plain = test::trackShape("bend", 1, {0.05}).value;
  formats::Case scaled = scaledBy(plain, 8);
  Progress progress;
  fit(plain, {}, progress);
  fit(scaled, {}, progress);
  ASSERT_EQ(scaled.models->width.size(), plain.models->width.size());
  for (std::size_t i = 0; i < plain.models->width.size(); ++i) {
    EXPECT_EQ(scaled.models->width[i], 8 * plain.models->width[i]);
    EXPECT_EQ(scaled.models->centre[i].x, 8 * plain.models->centre[i].x);
  }
}

TEST(Fit, AVesselTenTimesAsLargeIsFittedAsWell) {
  TrackedShape tracked = test::trackShape("bend", 1, {0.05});
  tracked.value = scaledBy(tracked.value, 10);
  for (auto& tube : tracked.shape.tubes) {
    tube.radius *= 10;
    for (auto& p : tube.line) p = {10 * p.x, 10 * p.y, 10 * p.z};
  }
  Progress progress;
  fit(tracked.value, {}, progress);
  const std::vector<double> plain = test::wallDistances(fitted("bend", 1, 0.05), 2);
  const std::vector<double> scaled = test::wallDistances(tracked, 2);
  EXPECT_NEAR(test::percentile(scaled, 0.5) / 10, test::percentile(plain, 0.5), 0.02 * kVoxel);
}

TEST(Fit, StoresWhatItUsed) {
  formats::Case value = test::trackShape("capsule", 1, {}).value;
  Progress progress;
  FitOptions options;
  options.isoLevel = 0.12;
  fit(value, options, progress);
  EXPECT_EQ(value.models->isoLevel, 0.12);
  EXPECT_EQ(value.models->offset.size(), value.tree.nodeCount() + 1);
  ASSERT_EQ(value.metadata.steps.size(), 1U);
  EXPECT_EQ(value.metadata.steps[0].name, "fit");
  EXPECT_EQ(value.metadata.steps[0].tool, "lumen " LUMEN_VERSION);
  EXPECT_EQ(std::get<double>(value.metadata.steps[0].parameters.at("iso-level")), 0.12);
}

TEST(Fit, ReplacesModelsThatAreThere) {
  TrackedShape tracked = fitted("capsule", 1, 0);
  const formats::BlobbyModels once = *tracked.value.models;
  Progress progress;
  fit(tracked.value, {}, progress);
  EXPECT_EQ(*tracked.value.models, once);
  EXPECT_EQ(tracked.value.metadata.steps.size(), 2U);
}

TEST(Fit, NodesWithoutPointsGetTwoBlobs) {
  formats::Case value = test::trackShape("tube", 1, {}).value;
  value.points->position.clear();
  value.points->offset.assign(value.tree.nodeCount() + 1, 0);
  Progress progress;
  fit(value, {}, progress);
  EXPECT_EQ(value.models->width.size(), 2 * value.tree.nodeCount());
}

TEST(Fit, ATreeWithoutNodesHasNoModels) {
  formats::Case value;
  value.metadata.voxelSize = 0.2;
  value.points = formats::PointSets{{0}, {}};
  Progress progress;
  fit(value, {}, progress);
  EXPECT_EQ(value.models->offset, std::vector<std::uint32_t>{0});
}

TEST(Fit, RefusesACaseWithoutPoints) {
  formats::Case value = test::trackShape("tube", 1, {}).value;
  value.points.reset();
  Progress progress;
  try {
    fit(value, {}, progress);
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::InvalidInput);
  }
}

TEST(Fit, RefusesACaseWithoutAVoxelSize) {
  formats::Case value = test::trackShape("tube", 1, {}).value;
  value.metadata.voxelSize.reset();
  Progress progress;
  EXPECT_THROW(fit(value, {}, progress), Error);
}

TEST(Fit, WithoutAVoxelSizeTheIsoLevelSetsTheScale) {
  formats::Case with = test::trackShape("capsule", 1, {}).value, without = with;
  without.metadata.voxelSize.reset();
  Progress progress;
  fit(with, {}, progress);
  fit(without, FitOptions().resolved(0.2), progress);
  EXPECT_EQ(*with.models, *without.models);
}

TEST(Fit, CancelledStopsAndLeavesTheCaseAlone) {
  formats::Case value = test::trackShape("tube", 1, {}).value;
  const formats::Case before = value;
  Progress progress;
  progress.cancel();
  try {
    fit(value, {}, progress);
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Cancelled);
  }
  EXPECT_EQ(value, before);
}

TEST(Fit, ReportsEveryNodeOnceAndOnceForEverySweep) {
  class Counter : public Progress {
  public:
    void begin(std::string_view, std::size_t total) override { m_total = total; }
    void advance(std::size_t units) override { m_done += units; }
    std::size_t m_total = 0;
    std::atomic<std::size_t> m_done{0};
  } progress;
  formats::Case value = test::trackShape("tube", 1, {}).value;
  fit(value, {}, progress);
  const std::size_t passes = 1 + static_cast<std::size_t>(FitOptions().seamSweeps);
  EXPECT_EQ(progress.m_total, passes * value.tree.nodeCount());
  EXPECT_EQ(progress.m_done, progress.m_total);
}

}  // namespace
}  // namespace lumen::convert
