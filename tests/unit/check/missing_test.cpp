// SPDX-License-Identifier: Apache-2.0
// Vessels that a case leaves out, ends that stop short of them, and bright voxels that are no vessel.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "converters/draw/overlay/overlay.h"
#include "converters/judge/check/check.h"
#include "converters/stages/phantom/phantom.h"
#include "straight_models.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kEdge = 64;                     // voxels
constexpr float kDark = 100, kBright = 1100;  // the phantoms' levels

/// The tube; its nodes run along the volume.
struct Tube {
  Phantom phantom;
  double radius = 0;
  Tube() {
    PhantomOptions options;
    options.name = "tube";
    options.size = kEdge;
    options.noise = 0;
    options.bias = 0;
    Progress progress;
    phantom = makePhantom(options, progress);
    radius = static_cast<double>(tree().radius[0]);
    addStraightModels(phantom.truth, radius);
  }
  formats::CenterlineTree& tree() { return phantom.truth.tree; }
  Vector3d centre(std::size_t n) { return toEigen(tree().centre[n]); }

  /// The case of the first `count` nodes.
  void cut(std::uint32_t count) {
    formats::CenterlineTree& t = tree();
    for (auto* list : {&t.centre, &t.direction}) list->resize(count);
    for (auto* list : {&t.radius, &t.height}) list->resize(count);
    t.parent.resize(count);
    t.branch.resize(count);
    t.inlierRate.clear();
    t.branches[0].nodeCount = count;
    addStraightModels(phantom.truth, radius);
    // models are long rows of blobs: that of the last node would go on
    auto& models = *phantom.truth.models;
    const Vector3d end = centre(count - 1), along = toEigen(t.direction[count - 1]);
    for (std::size_t i = 0; i < models.centre.size(); ++i)
      if ((toEigen(models.centre[i]) - end).dot(along) > -radius) models.width[i] *= 1e-3F;
  }

  /// Raises every voxel to levelAt(its centre), mm.
  template <class Level>
  void paint(Level&& levelAt) {
    auto& voxels = std::get<std::vector<std::int16_t>>(phantom.volume.voxels);
    std::size_t i = 0;
    for (int z = 0; z < kEdge; ++z)
      for (int y = 0; y < kEdge; ++y)
        for (int x = 0; x < kEdge; ++x, ++i)
          voxels[i] = std::max(
              voxels[i], static_cast<std::int16_t>(levelAt(phantom.volume.geometry.worldFromIndex(
                             {double(x), double(y), double(z)}))));
  }

  CheckReport report() {
    Progress progress;
    return checkCase(phantom.volume, phantom.truth, {kBlur, false}, progress).report;
  }
};

/// The tube in soft tissue of computed tomography, with spongy bone beside it and air in a corner; `offset` is
/// added to Hounsfield units.
CheckReport besideBone(int offset) {
  Tube tube;
  const VolumeGeometry& geometry = tube.phantom.volume.geometry;
  const Vector3d middle = geometry.indexFromWorld(tube.centre(tube.tree().nodeCount() / 2));
  const double wall = tube.radius / geometry.spacing[0];
  auto& voxels = std::get<std::vector<std::int16_t>>(tube.phantom.volume.voxels);
  Random random(5);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const Cell cell = geometry.cell(i);
    double value = 40 + 0.3 * (static_cast<double>(voxels[i]) - double{kDark});
    const double beside = cell[0] - middle[0];
    if (beside > wall + 0.5 && cell[2] > 16 && cell[2] < 48) value = 450 + 200 * random.normal();
    if (cell[0] < 10) value = -1000;
    voxels[i] = static_cast<std::int16_t>(std::lround(value + 5 * random.normal() + offset));
  }
  return tube.report();
}

TEST(Missing, BoneOfComputedTomographyIsNoVessel) {
  EXPECT_GT(besideBone(300).missingLength(), 1)
      << "no scale of tomography: all that is bright counts";
  EXPECT_EQ(besideBone(0).missingLength(), 0);
}

TEST(OpenEnds, ABranchThatStopsShortSaysHowFarTheVesselGoesOn) {
  Tube tube;
  const auto count = static_cast<std::uint32_t>(tube.tree().nodeCount());
  const Vector3d whole = tube.centre(count - 1);
  tube.cut(count / 2);
  const double beyond = (whole - tube.centre(count / 2 - 1)).norm();
  const CheckReport report = tube.report();
  ASSERT_EQ(report.ends.size(), 2U);
  EXPECT_TRUE(report.ends[0].first);
  EXPECT_EQ(report.ends[0].node, 0U);
  EXPECT_EQ(report.ends[0].goesOn, 0);
  EXPECT_EQ(report.ends[1].node, count / 2 - 1);
  EXPECT_NEAR(report.ends[1].goesOn, beyond, tube.radius + 3 * kVoxel);
  ASSERT_EQ(report.missing.vessels.size(), 1U);
  EXPECT_TRUE(report.missing.vessels[0].atEnd);
  const double coverage = report.shownLength / (report.shownLength + report.missingLength());
  EXPECT_NEAR(coverage, 0.5, 0.1);
}

TEST(Overlay, MarksWhatIsMissing) {
  Tube tube;
  const auto marked = [&] {
    const Picture picture = drawOverlay(tube.phantom.volume, tube.tree(), tube.report());
    // above the legend, where the same colour explains itself
    return std::count_if(picture.pixels.begin(),
                         picture.pixels.begin() + std::ptrdiff_t{400} * picture.width,
                         [](const Rgb& p) { return p[0] > 200 && p[1] < 150 && p[2] > 200; });
  };
  EXPECT_EQ(marked(), 0);
  tube.cut(static_cast<std::uint32_t>(tube.tree().nodeCount() / 2));
  EXPECT_GT(marked(), 50);
}

TEST(OpenEnds, AreNoneOfAWholeVessel) {
  Tube tube;
  const CheckReport report = tube.report();
  for (const OpenEnd& end : report.ends) EXPECT_EQ(end.goesOn, 0);
  EXPECT_EQ(report.missingLength(), 0);
}

TEST(ShownLength, CountsBranchesThatLieInEachOtherOnce) {
  Tube tube;
  const double once = tube.report().shownLength;
  const double length = (tube.centre(tube.tree().nodeCount() - 1) - tube.centre(0)).norm();
  EXPECT_NEAR(once, length, 0.02 * length);
  formats::CenterlineTree& tree = tube.tree();
  const auto count = static_cast<std::uint32_t>(tree.nodeCount());
  for (std::uint32_t n = 0; n < count; ++n) {
    tree.centre.push_back(tree.centre[n]);
    tree.direction.push_back(tree.direction[n]);
    tree.radius.push_back(tree.radius[n] * 0.99F);
    tree.height.push_back(tree.height[n]);
    tree.parent.push_back(n == 0 ? formats::kNoParent : static_cast<std::int32_t>(count + n - 1));
    tree.branch.push_back(1);
  }
  tree.inlierRate.clear();
  tree.branches.push_back(tree.branches[0]);
  tree.branches[1].firstNode = count;
  addStraightModels(tube.phantom.truth, tube.radius);
  EXPECT_NEAR(tube.report().shownLength, once, 0.02 * once);
}

// A ball three times as wide as the vessel touches it, and a thin vessel leaves the ball.
TEST(Missing, WhatIsWiderThanTheCaseIsARegionAndAllBeyondIt) {
  Tube tube;
  const Vector3d side = toEigen(tube.tree().direction[0]).unitOrthogonal();
  const double ball = 3 * tube.radius, thin = 2 * kVoxel;
  const Vector3d middle = tube.centre(tube.tree().nodeCount() / 2);
  const Vector3d centre = middle + (tube.radius + ball - kVoxel) * side;
  const Vector3d along = toEigen(tube.tree().direction[0]);
  tube.paint([&](const Vector3d& p) {
    const Vector3d from = p - centre;
    const double ahead = from.dot(along);
    const bool stick = ahead > 0 && ahead < ball + 2 && (from - ahead * along).norm() < thin;
    return from.norm() < ball || stick ? kBright : kDark;
  });
  const CheckReport report = tube.report();
  EXPECT_TRUE(report.missing.vessels.empty());
  ASSERT_EQ(report.missing.wide.regions.size(), 1U);
  const Region& region = report.missing.wide.regions[0];
  EXPECT_GT(region.radius, 1.5 * tube.radius);
  EXPECT_LT((region.position - centre).norm(), ball);
  EXPECT_EQ(report.missingLength(), 0);
}

// Cubes of three voxels with levels of up to half the contrast, through which a faint branch runs.
TEST(Missing, TextureOfTheBackgroundIsNoVessel) {
  Tube tube;
  const VolumeGeometry geometry = tube.phantom.volume.geometry;
  tube.paint([&](const Vector3d& p) {
    const Vector3d index = geometry.indexFromWorld(p);
    std::uint32_t hash = 17;
    for (int a = 0; a < 3; ++a)
      hash = (hash ^ static_cast<std::uint32_t>(std::lround(index[a]) / 3)) * 2654435761U;
    return kDark + 0.5F * (kBright - kDark) * static_cast<float>(hash >> 16 & 255U) / 255;
  });
  formats::CenterlineTree& tree = tube.tree();
  const auto count = static_cast<std::uint32_t>(tree.nodeCount());
  for (std::uint32_t n = 0; n < count; ++n) {
    tree.centre.push_back(tree.centre[n]);
    tree.centre.back().x -= 3;
    tree.direction.push_back(tree.direction[n]);
    tree.radius.push_back(tree.radius[n]);
    tree.height.push_back(tree.height[n]);
    tree.parent.push_back(n == 0 ? formats::kNoParent : static_cast<std::int32_t>(count + n - 1));
    tree.branch.push_back(1);
  }
  tree.inlierRate.clear();
  tree.branches.push_back(tree.branches[0]);
  tree.branches[1].firstNode = count;
  addStraightModels(tube.phantom.truth, tube.radius);
  const CheckReport report = tube.report();
  EXPECT_LT(report.missingLength(), 0.1 * report.shownLength);
}

}  // namespace
}  // namespace lumen::convert
