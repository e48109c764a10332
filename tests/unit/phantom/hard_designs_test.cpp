// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/render.h"
#include "small_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

Phantom make(const std::string& name, double slice = 0) {
  PhantomOptions options;
  options.name = name;
  options.size = 64;
  options.noise = options.bias = options.psf = 0;
  options.sliceThickness = slice;
  Progress progress;
  return makePhantom(options, progress);
}

double sumOf(const Phantom& phantom) {
  double sum = 0;
  for (const std::int16_t v : std::get<std::vector<std::int16_t>>(phantom.volume.voxels))
    sum += (v - kBackground) / kContrast;
  return sum;
}

TEST(HardPhantoms, CompanionsTouchOverSevenTenthsOfTheExtentAndDifferInBrightness) {
  const Design design = designCompanion(kFrame);
  const TubeTreeDistance artery(design.tree, 0);
  const formats::Branch& vein = design.tree.branches[1];
  double touching = 0;
  for (std::uint32_t n = vein.firstNode; n < vein.firstNode + vein.nodeCount; ++n) {
    EXPECT_FLOAT_EQ(design.contrast[n], 0.55F);
    const double gap = artery.nearest(toEigen(design.tree.centre[n])).distance -
                       static_cast<double>(design.tree.radius[n]);
    EXPECT_GT(gap, -0.005);
    if (gap < 0.02) touching += static_cast<double>(design.tree.height[n]);
  }
  EXPECT_GT(touching, 0.7 * 25.4);
  EXPECT_FLOAT_EQ(design.contrast[0], 1);
}

TEST(HardPhantoms, TheHairpinsLimbsComeAsCloseAsItsTightestBend) {
  const Design design = designHairpin(kFrame);
  double reversals = 0, nearest = 1e9;
  const auto last = static_cast<std::uint32_t>(design.tree.nodeCount());
  for (std::uint32_t n = 1; n < last; ++n)
    if (toEigen(design.tree.direction[n]).x() * toEigen(design.tree.direction[n - 1]).x() < 0)
      ++reversals;
  // limbs are apart by the bend's diameter; nodes less than half a turn apart do not count
  for (std::uint32_t a = 0; a < last; ++a)
    for (std::uint32_t b = a + 38; b < last; ++b)
      nearest = std::min(nearest,
                         (toEigen(design.tree.centre[a]) - toEigen(design.tree.centre[b])).norm());
  EXPECT_EQ(reversals, 3);
  EXPECT_NEAR(nearest, 2 * 1.5 * 0.8, 0.05);
}

TEST(HardPhantoms, ChildrenLeaveTheWideParentAtRightAngles) {
  const Design design = designRightAngle(kFrame);
  ASSERT_EQ(design.tree.branches.size(), 3U);
  for (const std::size_t b : {1U, 2U}) {
    const formats::Branch& child = design.tree.branches[b];
    const auto parentNode = static_cast<std::uint32_t>(child.parentNode);
    EXPECT_NEAR(toEigen(design.tree.direction[child.firstNode])
                    .dot(toEigen(design.tree.direction[parentNode])),
                0, 1e-6);
    EXPECT_LT(design.tree.radius[child.firstNode], 0.5F * design.tree.radius[parentNode]);
  }
}

TEST(HardPhantoms, FadingLosesContrastAlongTheWayFromTheRootOnly) {
  const Design design = designFading(kFrame);
  EXPECT_FLOAT_EQ(design.contrast[0], 1);
  for (std::uint32_t n = 1; n < design.tree.nodeCount(); ++n)
    EXPECT_LE(design.contrast[n], design.contrast[static_cast<std::size_t>(design.tree.parent[n])]);
  EXPECT_NEAR(*std::min_element(design.contrast.begin(), design.contrast.end()), 0.35F, 1e-6);
}

TEST(HardPhantoms, TheSacSitsInTheForkAndLobesStandOutOfIt) {
  const Design design = designSacLobes(kFrame);
  ASSERT_EQ(design.tree.branches.size(), 5U);
  const TubeTreeDistance sac(design.tree, 2), fork0(design.tree, 0), fork1(design.tree, 1);
  for (const std::size_t b : {3U, 4U}) {
    const formats::Branch& lobe = design.tree.branches[b];
    EXPECT_EQ(lobe.kind, formats::BranchKind::Aneurysm);
    EXPECT_EQ(design.tree.branch[static_cast<std::size_t>(lobe.parentNode)], 2U);
    const std::uint32_t last = lobe.firstNode + lobe.nodeCount - 1;
    const double radius = static_cast<double>(design.tree.radius[last]);
    const double outside = sac.nearest(toEigen(design.tree.centre[last])).distance + radius;
    EXPECT_GT(outside, radius);
    EXPECT_LT(outside, 2 * radius);
  }
  // the sac's body is clear of both children beyond its neck
  const formats::Branch& body = design.tree.branches[2];
  const std::uint32_t last = body.firstNode + body.nodeCount - 1;
  const double radius = static_cast<double>(design.tree.radius[last]);
  for (const TubeTreeDistance* child : {&fork0, &fork1})
    EXPECT_GT(child->nearest(toEigen(design.tree.centre[last])).distance, radius);
}

TEST(ThickSlices, AreFiveVoxelsThickAndKeepTheVolumeOfTheVessels) {
  const Phantom thick = make("thick-slices"), thin = make("thick-slices", 0.2);
  EXPECT_EQ(thick.volume.geometry.size, (std::array<int, 3>{64, 64, 12}));
  EXPECT_NEAR(thick.volume.geometry.spacing.z(), 1.0, 1e-12);
  EXPECT_NEAR(thick.volume.geometry.origin.z(), 0.4, 1e-12);
  EXPECT_EQ(thin.volume.geometry.size[2], 64);
  EXPECT_NEAR(5 * sumOf(thick), sumOf(thin), 0.002 * sumOf(thin));
  EXPECT_NEAR(*thick.truth.metadata.voxelSize, std::cbrt(0.2 * 0.2 * 1.0), 1e-9);
}

TEST(ThickSlices, TakeTheShareOfAVoxelThatTheyEndIn) {
  Image image{{1, 1, 5}, {1, 2, 4, 8, 16}};
  const Image thick = averageSlices(image, 2.5);
  ASSERT_EQ(thick.size[2], 2);
  EXPECT_FLOAT_EQ(thick.value[0], (1 + 2 + 0.5F * 4) / 2.5F);
  EXPECT_FLOAT_EQ(thick.value[1], (0.5F * 4 + 8 + 16) / 2.5F);
}

TEST(ThickSlices, ThatAreThinnerThanAVoxelOrTooFewAreRefused) {
  EXPECT_THROW(make("tube", 0.1), Error);
  EXPECT_THROW(make("tube", 4.0), Error);
}

}  // namespace
}  // namespace lumen::convert
