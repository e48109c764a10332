// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/render.h"
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

using Eigen::Vector3d;

double note(const Design& design, const std::string& name) {
  return std::get<double>(design.notes.at("true." + name));
}

double lengthOf(const Design& design, std::size_t branch) {
  const formats::Branch& b = design.tree.branches[branch];
  double length = 0;
  for (std::uint32_t n = b.firstNode + 1; n < b.firstNode + b.nodeCount; ++n)
    length += (toEigen(design.tree.centre[n]) - toEigen(design.tree.centre[n - 1])).norm();
  return length;
}

TEST(MeasuredPhantoms, AxesHaveTheLengthsThatTheTruthStates) {
  for (const auto& make : {designHelix, designCoil, designArc, designCone, designEllipseTube}) {
    const Design design = make(kFrame);
    EXPECT_NEAR(lengthOf(design, 0) / note(design, "root.length_mm"), 1, 2e-5);
  }
}

TEST(MeasuredPhantoms, ThreeNodesOfTheCoilLieOnACircleOfItsCurvature) {
  const Design design = designCoil(kFrame);
  const Vector3d a = toEigen(design.tree.centre[100]), b = toEigen(design.tree.centre[110]),
                 c = toEigen(design.tree.centre[120]);
  const double area = 0.5 * (b - a).cross(c - a).norm();
  const double curvature = 4 * area / ((b - a).norm() * (c - b).norm() * (c - a).norm());
  EXPECT_NEAR(curvature, note(design, "root.curvature_per_mm"), 2e-3);
}

// Voxels of a phantom without blur and noise fill the volume that the truth states: a tube between
// two faces, by Cavalieri's principle.
TEST(MeasuredPhantoms, TheEllipticTubeFillsItsVolume) {
  PhantomOptions options;
  options.name = "ellipse-tube";
  options.noise = options.bias = options.psf = 0;
  Progress progress;
  const Phantom phantom = makePhantom(options, progress);
  double sum = 0;
  for (const std::int16_t v : std::get<std::vector<std::int16_t>>(phantom.volume.voxels))
    sum += (v - kBackground) / kContrast;
  // half a voxel lies beyond each face
  const double volume = note(designEllipseTube(kFrame), "root.volume_mm3") * 25.6 / 25.4;
  EXPECT_NEAR(sum * 0.008 / volume, 1, 2e-3);
}

// The part of a sac beyond its neck plane, counted on a grid.
TEST(MeasuredPhantoms, SacsHaveTheVolumesThatTheTruthStatesBeyondTheirNecks) {
  for (const auto& make : {designSacSphere, designSacEllipsoid, designSacFork}) {
    const Design design = make(kFrame);
    const TubeTreeDistance wall(design.tree);
    const formats::Branch& sac = design.tree.branches.back();
    const Vector3d out = toEigen(design.tree.direction[sac.firstNode + 10]);
    const Vector3d axis = toEigen(design.tree.centre[sac.firstNode]);
    const double plane = static_cast<double>(design.tree.radius[0]);
    const double step = 0.1;
    double volume = 0;
    for (double x = 0; x < 25.4; x += step)
      for (double y = 0; y < 25.4; y += step)
        for (double z = 5; z < 25.4; z += step) {
          const Vector3d p(x, y, z);
          if ((p - axis).dot(out) < plane || (p - axis).norm() > 9) continue;
          // beyond the tangent plane lies the sac alone
          volume += std::clamp(0.5 - wall.nearest(p).distance / step, 0.0, 1.0);
        }
    EXPECT_NEAR(volume * step * step * step / note(design, "sac.dome_volume_mm3"), 1, 0.01);
  }
}

TEST(MeasuredPhantoms, AHemisphereWouldHaveNoEllipticity) {
  const double index = 1 - std::cbrt(18 * std::numbers::pi) *
                               std::pow(2 * std::numbers::pi / 3, 2.0 / 3) / (2 * std::numbers::pi);
  EXPECT_NEAR(index, 0, 1e-12);
  // more of the ball than its half lies beyond the neck
  EXPECT_GT(note(designSacSphere(kFrame), "sac.ellipticity_index"), 0.05);
}

TEST(MeasuredPhantoms, TheForkStatesTheAnglesOfItsAxes) {
  const Design design = designFork(kFrame);
  const formats::Branch &root = design.tree.branches[0], &child = design.tree.branches[1];
  const Vector3d trunk = toEigen(design.tree.direction[3]),
                 one = toEigen(design.tree.direction[root.firstNode + root.nodeCount - 2]),
                 two = toEigen(design.tree.direction[child.firstNode + child.nodeCount - 2]);
  const auto degrees = [](const Vector3d& a, const Vector3d& b) {
    return std::acos(a.dot(b)) * 180 / std::numbers::pi;
  };
  EXPECT_NEAR(degrees(trunk, one), note(design, "b01.fork_continuing_in_plane_deg"), 0.1);
  EXPECT_NEAR(degrees(trunk, two), note(design, "b01.fork_branching_in_plane_deg"), 0.1);
  EXPECT_NEAR(degrees(one, two), note(design, "b01.fork_between_deg"), 0.1);
}

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
