// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/error_of_fit.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "formats/case/blobby.h"

namespace lumen::convert {
namespace {

/// Two nodes, each with one blob whose surface is the unit sphere around it; ten points around the
/// first.
formats::Case twoSpheres() {
  formats::Case value;
  value.tree.centre = {{0, 0, 0}, {5, 0, 0}};
  value.tree.direction = {{1, 0, 0}, {1, 0, 0}};
  value.tree.radius = {1, 1};
  value.tree.height = {1, 1};
  value.tree.parent = {formats::kNoParent, 0};
  value.tree.branch = {0, 0};
  value.points = formats::PointSets{{0, 10, 10}, {}};
  for (int i = 0; i < 10; ++i) {
    value.points->position.push_back({1 + 0.001F * static_cast<float>(i), 0, 0});
  }
  formats::BlobbyModels models;
  const auto width = static_cast<float>(
      formats::widthForRadius(models.kernel, models.kernelParameter, 1, models.isoLevel));
  models.offset = {0, 1, 2};
  models.centre = value.tree.centre;
  models.width = {width, width};
  value.models = models;
  return value;
}

TEST(ErrorOfFit, IsTheNinthOfTenDistances) {
  Progress progress;
  const std::vector<float> errors = errorOfFit(twoSpheres(), 0, progress);
  // points lie 0, 1, .. 9 micrometres outside; the ninth distance is 8
  EXPECT_NEAR(errors[0], 0.008, 1e-4);
}

TEST(ErrorOfFit, OfANodeWithoutPointsIsNotANumber) {
  Progress progress;
  EXPECT_TRUE(std::isnan(errorOfFit(twoSpheres(), 0, progress)[1]));
}

TEST(ErrorOfFit, CountsThePointsOfTheNeighbours) {
  Progress progress;
  const float far = errorOfFit(twoSpheres(), 1, progress)[1];
  EXPECT_GT(far, 1);
}

TEST(ErrorOfFit, FarFromTheWallIsStillADistance) {
  formats::Case value = twoSpheres();
  for (auto& p : value.points->position) p = {3, 0, 0};
  Progress progress;
  // one blob, whose h is exactly h_0 + c r^2: the distance is exact
  EXPECT_NEAR(errorOfFit(value, 0, progress)[0], 2, 0.01);
  EXPECT_GT(errorOfFit(value, 0, progress, FitDistance::Taubin)[0], 10);
}

TEST(ErrorOfFit, OnTheAxisIsTheRadius) {
  formats::Case value = twoSpheres();
  for (auto& p : value.points->position) p = {0, 0, 0};
  Progress progress;
  EXPECT_NEAR(errorOfFit(value, 0, progress)[0], 1, 1e-6);
  EXPECT_EQ(errorOfFit(value, 0, progress, FitDistance::Taubin)[0],
            std::numeric_limits<float>::infinity());
}

TEST(ErrorOfFit, WhereACompactKernelVanishesIsTheFarSideOfTheNode) {
  formats::Case value = twoSpheres();
  value.models->kernel = formats::Kernel::Quartic;
  for (auto& p : value.points->position) p = {100, 0, 0};
  Progress progress;
  EXPECT_EQ(errorOfFit(value, 0, progress)[0], 101);
}

TEST(ErrorOfFit, OfANodeWithoutBlobsIsInfinite) {
  formats::Case value = twoSpheres();
  value.models->offset = {0, 0, 2};
  Progress progress;
  EXPECT_EQ(errorOfFit(value, 0, progress)[0], std::numeric_limits<float>::infinity());
}

TEST(ErrorOfFit, NeedsPointsAndModels) {
  Progress progress;
  formats::Case value = twoSpheres();
  value.points.reset();
  EXPECT_THROW((void)errorOfFit(value, 0, progress), Error);
  value = twoSpheres();
  value.models.reset();
  EXPECT_THROW((void)errorOfFit(value, 0, progress), Error);
}

TEST(ErrorOfFit, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW((void)errorOfFit(twoSpheres(), 0, progress), Error);
}

TEST(SummariseErrorOfFit, LeavesOutNodesWithoutOne) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const ErrorOfFitSummary s = summariseErrorOfFit({4, none, 1, 3, 2, none, 5, 6, 7, 8, 9, 10});
  EXPECT_EQ(s.median, 5);
  EXPECT_EQ(s.p90, 9);
  EXPECT_EQ(s.max, 10);
}

TEST(SummariseErrorOfFit, OfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(summariseErrorOfFit({}).median));
}

}  // namespace
}  // namespace lumen::convert
