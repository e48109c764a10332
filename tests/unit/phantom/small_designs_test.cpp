// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"
#include "formats/case/case_file.h"
#include "small_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

double radius(const Design& design, std::size_t node) {
  return static_cast<double>(design.tree.radius[node]);
}

TEST(SmallPhantoms, AllHaveATruthThatTheFormatAccepts) {
  for (const std::string& name : phantomNames()) {
    PhantomOptions options;
    options.name = name;
    options.size = name == "patient" ? 128 : 64;
    Progress progress;
    const Phantom phantom = makePhantom(options, progress);
    const formats::Status valid = formats::validate(phantom.truth);
    EXPECT_TRUE(valid) << name << ": " << valid.error().text();
    EXPECT_EQ(phantom.truth.metadata.source->size[0], static_cast<std::uint32_t>(options.size));
    EXPECT_EQ(phantom.truth.metadata.source->sha256.size(), 64U);
  }
}

TEST(SmallPhantoms, NodesAreHalfAVoxelApart) {
  for (const auto& make : {designTube, designHelix, designBifurcation, designKissing,
                           designAneurysm, designStenosis, designDropout}) {
    const Design design = make(kFrame);
    for (std::uint32_t n = 1; n < design.tree.nodeCount(); ++n)
      if (design.tree.branch[n] == design.tree.branch[n - 1]) {
        EXPECT_NEAR((toEigen(design.tree.centre[n]) - toEigen(design.tree.centre[n - 1])).norm(),
                    0.1, 0.003);
        EXPECT_NEAR(toEigen(design.tree.direction[n]).norm(), 1, 1e-6);
      }
  }
}

TEST(SmallPhantoms, TheTubeCrossesTheVolumeFromFaceToFace) {
  const Design tube = designTube(kFrame);
  EXPECT_EQ(toEigen(tube.tree.centre[0]).z(), 0);
  EXPECT_NEAR(toEigen(tube.tree.centre[static_cast<std::uint32_t>(tube.tree.nodeCount() - 1)]).z(),
              25.4, 1e-5);
}

TEST(SmallPhantoms, TheBifurcationFollowsMurrayAndOpensBySeventyDegrees) {
  const Design design = designBifurcation(kFrame);
  const formats::Branch &root = design.tree.branches[0], &child = design.tree.branches[1];
  const std::uint32_t rootEnd = root.firstNode + root.nodeCount - 1,
                      childEnd = child.firstNode + child.nodeCount - 1;
  EXPECT_NEAR(std::pow(radius(design, 0), 3),
              std::pow(radius(design, rootEnd), 3) + std::pow(radius(design, childEnd), 3), 1e-5);
  EXPECT_LT(radius(design, childEnd), radius(design, rootEnd));
  const double cosine =
      toEigen(design.tree.direction[rootEnd]).dot(toEigen(design.tree.direction[childEnd]));
  EXPECT_NEAR(std::acos(cosine) * 180 / 3.14159265, 70, 1);
}

TEST(SmallPhantoms, AChildBeginsOnItsParentsAxis) {
  const Design design = designBifurcation(kFrame);
  const formats::Branch& child = design.tree.branches[1];
  EXPECT_LT((toEigen(design.tree.centre[child.firstNode]) -
             toEigen(design.tree.centre[static_cast<std::uint32_t>(child.parentNode)]))
                .norm(),
            0.06);
}

TEST(SmallPhantoms, KissingAxesAreTheSumOfTheRadiiApartOverAQuarterAndNeverNearer) {
  const Design design = designKissing(kFrame);
  const formats::Branch &a = design.tree.branches[0], &b = design.tree.branches[1];
  const double sum = radius(design, a.firstNode) + radius(design, b.firstNode);
  double touching = 0;
  for (std::uint32_t n = a.firstNode; n < a.firstNode + a.nodeCount; ++n) {
    double nearest = 1e9;
    for (std::uint32_t m = b.firstNode; m < b.firstNode + b.nodeCount; ++m)
      nearest = std::min(nearest,
                         (toEigen(design.tree.centre[n]) - toEigen(design.tree.centre[m])).norm());
    EXPECT_GE(nearest, sum - 1e-4);
    if (nearest < sum + 0.02) touching += static_cast<double>(design.tree.height[n]);
  }
  EXPECT_GT(touching, 25.4 / 4);
  EXPECT_LT(touching, 25.4 / 2);
}

TEST(SmallPhantoms, TheAneurysmIsASphereBehindANeck) {
  const Design design = designAneurysm(kFrame);
  const TubeTreeDistance wall(design.tree);
  const formats::Branch& sac = design.tree.branches[1];
  const Vector3d centre = toEigen(design.tree.centre[sac.firstNode + sac.nodeCount - 1]);
  EXPECT_EQ(sac.kind, formats::BranchKind::Aneurysm);
  EXPECT_NEAR(wall.nearest(centre).distance, -2.6, 1e-5);
  EXPECT_NEAR(wall.nearest(centre + Vector3d(0, 0, 3)).distance, 0.4, 1e-5);
  // a ball of the neck's radius is the widest between parent and sphere
  const Vector3d neck = toEigen(design.tree.centre[sac.firstNode + 12]);
  EXPECT_NEAR(wall.nearest(neck).distance, -0.7, 1e-5);
}

TEST(SmallPhantoms, TheStenosisNarrowsTo45PerCent) {
  const Design design = designStenosis(kFrame);
  const auto [low, high] =
      std::minmax_element(design.tree.radius.begin(), design.tree.radius.end());
  EXPECT_NEAR(static_cast<double>(*low / *high), 0.45, 0.002);
}

TEST(SmallPhantoms, TheDropoutLosesContrastOverFourAndAHalfDiametersTwice) {
  const Design design = designDropout(kFrame);
  double lost = 0;
  for (std::size_t n = 0; n < design.contrast.size(); ++n)
    if (design.contrast[n] < 0.675F) lost += static_cast<double>(design.tree.height[n]);
  EXPECT_NEAR(lost, 2 * 4.5 * 2 * radius(design, 0), 0.4);
  EXPECT_NEAR(
      static_cast<double>(*std::min_element(design.contrast.begin(), design.contrast.end())), 0.35,
      1e-6);
}

TEST(SmallPhantoms, AnUnknownNameIsAUsageError) {
  PhantomOptions options;
  options.name = "spiral";
  Progress progress;
  try {
    makePhantom(options, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
  }
}

TEST(SmallPhantoms, StopWhenCancelled) {
  PhantomOptions options;
  options.name = "tube";
  Progress progress;
  progress.cancel();
  try {
    makePhantom(options, progress);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Cancelled);
  }
}

}  // namespace
}  // namespace lumen::convert
