// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/image/fit_to_image.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"
#include "formats/case/node_origin.h"

namespace lumen::convert {
namespace {

struct Tracked {
  Phantom phantom;
  formats::Case value;
};

Tracked trackPhantom(const std::string& name, double noise) {
  PhantomOptions options;
  options.name = name;
  options.size = 64;
  options.voxel = 0.4;
  options.noise = noise;
  Progress silent;
  Tracked tracked{makePhantom(options, silent), {}};
  tracked.value =
      trackFromSeeds(tracked.phantom.volume, tracked.phantom.seeds, TrackOptions{}, silent).result;
  return tracked;
}

ImageFitReport fitImage(formats::Case& value, const Volume& volume) {
  Progress silent;
  return fitToImage(value, volume, recordedImageFit(value, volume), silent);
}

/// The root mean square, in voxels, of the distances of wall points from the true wall.
double pointError(const Tracked& tracked) {
  const TubeTreeDistance wall(tracked.phantom.truth.tree);
  double sum = 0;
  for (const formats::Vec3f& p : tracked.value.points->position) {
    const double d = wall.nearest(toEigen(p)).distance;
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(tracked.value.points->position.size())) / 0.4;
}

TEST(FitToImage, BringsWallPointsNearerToTheWallInNoise) {
  Tracked tracked = trackPhantom("tube", 0.15);
  const double before = pointError(tracked);
  const ImageFitReport report = fitImage(tracked.value, tracked.phantom.volume);
  EXPECT_LT(pointError(tracked), 0.6 * before);
  EXPECT_GT(report.nodes, 10 * report.kept);
  EXPECT_EQ(report.nodes + report.kept, tracked.value.tree.nodeCount());
}

TEST(FitToImage, MeasuresTheBlur) {
  Tracked tracked = trackPhantom("tube", 0.02);
  // a voxel's own box and a scanner of 0.6 voxels, which the phantom draws on voxels
  EXPECT_NEAR(fitImage(tracked.value, tracked.phantom.volume).blur / 0.4, 0.63, 0.03);
}

TEST(FitToImage, RecordsItsStep) {
  Tracked tracked = trackPhantom("tube", 0.02);
  const ImageFitReport report = fitImage(tracked.value, tracked.phantom.volume);
  const formats::Step& step = tracked.value.metadata.steps.back();
  EXPECT_EQ(step.name, "fit-image");
  EXPECT_EQ(std::get<double>(step.parameters.at("blur")), report.blur);
}

// errors of the radii of a tube, in their standard deviations
TEST(FitToImage, StatesHowWellRadiiAreKnown) {
  Tracked tracked = trackPhantom("tube", 0.15);
  const ImageFitReport report = fitImage(tracked.value, tracked.phantom.volume);
  fitImage(tracked.value, tracked.phantom.volume);  // replaces the array
  ASSERT_EQ(std::count(tracked.value.metadata.extensionsUsed.begin(),
                       tracked.value.metadata.extensionsUsed.end(), "LUMEN_image"),
            1);
  const auto& arrays = tracked.value.nodeArrays;
  const auto array = std::find_if(arrays.begin(), arrays.end(), [](const formats::NodeArray& a) {
    return a.name == "LUMEN_image.deviation";
  });
  ASSERT_NE(array, arrays.end());
  EXPECT_EQ(array->unit, "mm");
  const auto& deviation = std::get<std::vector<float>>(array->values);
  ASSERT_EQ(deviation.size(), tracked.value.tree.nodeCount());
  std::vector<double> shares;
  const double truth = double{tracked.phantom.truth.tree.radius[0]};
  for (std::size_t i = 0; i < deviation.size(); ++i)
    if (deviation[i] > 0)
      shares.push_back(std::abs(double{tracked.value.tree.radius[i]} - truth) /
                       double{deviation[i]});
  EXPECT_GT(shares.size(), report.nodes / 2);
  std::sort(shares.begin(), shares.end());
  // the normal distribution has its median of sizes at .67, and 1.96 at 95 %
  EXPECT_GT(shares[shares.size() / 2], 0.2);
  EXPECT_LT(shares[shares.size() / 2], 1.5);
}

TEST(FitToImage, GivesTheSameBitsWithOneThread) {
  Tracked tracked = trackPhantom("kissing", 0.05);
  formats::Case other = tracked.value;
  fitImage(tracked.value, tracked.phantom.volume);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  fitImage(other, tracked.phantom.volume);
  EXPECT_EQ(tracked.value, other);
}

TEST(FitToImage, FitsDarkVessels) {
  Tracked tracked = trackPhantom("tube", 0.02);
  formats::Case dark = tracked.value;
  Volume negative = tracked.phantom.volume;
  for (auto& v : std::get<std::vector<std::int16_t>>(negative.voxels))
    v = static_cast<std::int16_t>(-v);
  Progress silent;
  ImageFitOptions options = recordedImageFit(dark, negative);
  options.dark = true;
  fitToImage(dark, negative, options, silent);
  fitImage(tracked.value, tracked.phantom.volume);
  EXPECT_EQ(dark.points, tracked.value.points);
}

TEST(FitToImage, LeavesAneurysmsAsTheyAre) {
  Tracked tracked = trackPhantom("aneurysm", 0.05);
  const formats::Case before = tracked.value;
  fitImage(tracked.value, tracked.phantom.volume);
  int sacs = 0;
  for (const formats::Branch& branch : before.tree.branches) {
    if (branch.kind != formats::BranchKind::Aneurysm) continue;
    for (std::uint32_t i = branch.firstNode; i < branch.firstNode + branch.nodeCount; ++i, ++sacs) {
      EXPECT_EQ(tracked.value.tree.centre[i], before.tree.centre[i]);
      EXPECT_EQ(tracked.value.points->offset[i + 1] - tracked.value.points->offset[i],
                before.points->offset[i + 1] - before.points->offset[i]);
    }
  }
  EXPECT_GT(sacs, 0);
}

TEST(FitToImage, LeavesWallsThatAPersonChanged) {
  Tracked tracked = trackPhantom("tube", 0.05);
  std::vector<bool> edited(tracked.value.tree.nodeCount(), false);
  edited[10] = true;
  formats::setEditedWalls(tracked.value, edited);
  const formats::Case before = tracked.value;
  fitImage(tracked.value, tracked.phantom.volume);
  EXPECT_EQ(tracked.value.tree.centre[10], before.tree.centre[10]);
  EXPECT_EQ(tracked.value.tree.radius[10], before.tree.radius[10]);
  EXPECT_NE(tracked.value.tree.radius[11], before.tree.radius[11]);
}

TEST(FitToImage, ThrowsWithoutWallPoints) {
  Tracked tracked = trackPhantom("tube", 0.02);
  tracked.value.points.reset();
  EXPECT_THROW(fitImage(tracked.value, tracked.phantom.volume), Error);
}

TEST(FitToImage, ThrowsAndChangesNothingWhereNoVesselShowsItsContrast) {
  Tracked tracked = trackPhantom("tube", 0.02);
  Volume even = tracked.phantom.volume;
  std::fill(std::get<std::vector<std::int16_t>>(even.voxels).begin(),
            std::get<std::vector<std::int16_t>>(even.voxels).end(), std::int16_t{7});
  const formats::Case before = tracked.value;
  EXPECT_THROW(fitImage(tracked.value, even), Error);
  EXPECT_EQ(tracked.value, before);
}

}  // namespace
}  // namespace lumen::convert
