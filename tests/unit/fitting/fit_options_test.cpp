// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/stages/fitting/fit.h"
#include "converters/stages/fitting/node_models.h"
#include "converters/stages/fitting/seam.h"
#include "formats/case/blobby.h"
#include "formats/case/node_origin.h"
#include "tests/unit/formats/beads.h"

namespace lumen::convert {
namespace {

void expectRefused(const FitOptions& options, const std::string& name) {
  try {
    (void)options.resolved(0.2);
    ADD_FAILURE() << name << " was accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
  }
}

TEST(FitOptions, LengthsScaleWithTheVoxel) {
  const FitOptions full = FitOptions().resolved(0.4);
  EXPECT_DOUBLE_EQ(*full.isoLevel, 0.2);
  EXPECT_DOUBLE_EQ(*full.accuracy, 0.6);
  EXPECT_DOUBLE_EQ(*full.maxDistance, 40);
  EXPECT_DOUBLE_EQ(*full.minWidth, 0.04);
}

TEST(FitOptions, GivenLengthsStay) {
  FitOptions options;
  options.accuracy = 0.25;
  EXPECT_EQ(*options.resolved(0.4).accuracy, 0.25);
}

TEST(FitOptions, TheKernelChoosesItsParameter) {
  FitOptions options;
  EXPECT_EQ(*options.resolved(0.2).kernelParameter, 0.2);
  options.kernel = formats::Kernel::Gaussian;
  EXPECT_EQ(*options.resolved(0.2).kernelParameter, 0.5);
}

TEST(FitOptions, WithoutAVoxelSizeEveryLengthMustBeGiven) {
  FitOptions options;
  EXPECT_THROW((void)options.resolved(0), Error);
  options.isoLevel = 0.1;
  options.accuracy = 0.3;
  options.maxDistance = 20;
  EXPECT_THROW((void)options.resolved(0), Error);
  options.minWidth = 0.02;
  EXPECT_NO_THROW((void)options.resolved(0));
}

TEST(FitOptions, OutOfRangeValuesAreRefusedByName) {
  const auto with = [](auto member, auto value) {
    FitOptions options;
    options.*member = value;
    return options;
  };
  expectRefused(with(&FitOptions::kernelParameter, 0.0), "kernel-parameter");
  expectRefused(with(&FitOptions::cohesionWeight, -1.0), "cohesion-weight");
  expectRefused(with(&FitOptions::curvatureWeight, std::nan("")), "curvature-weight");
  expectRefused(with(&FitOptions::cohesionScale, 0.0), "cohesion-scale");
  expectRefused(with(&FitOptions::maxSubdivisions, -1), "max-subdivisions");
  expectRefused(with(&FitOptions::maxSubdivisions, 1001), "max-subdivisions");
  expectRefused(with(&FitOptions::neighbourhood, -1), "neighbourhood");
  expectRefused(with(&FitOptions::seamSweeps, 101), "seam-sweeps");
  expectRefused(with(&FitOptions::seamWeight, -1.0), "seam-weight");
  expectRefused(with(&FitOptions::isoLevel, 0.0), "iso-level");
  expectRefused(with(&FitOptions::accuracy, -0.1), "accuracy");
  expectRefused(with(&FitOptions::maxDistance, std::numeric_limits<double>::infinity()),
                "max-distance");
  expectRefused(with(&FitOptions::minWidth, 0.0), "min-width");
}

TEST(FitOptions, ParametersHaveTheNamesOfTheOptions) {
  const auto values = FitOptions().resolved(0.2).parameters();
  std::string names;
  for (const auto& [name, value] : values) names += name + " ";
  EXPECT_EQ(names,
            "accuracy cohesion-scale cohesion-weight curvature-weight iso-level kernel "
            "kernel-parameter max-distance max-subdivisions min-width neighbourhood seam-sweeps "
            "seam-weight ");
  EXPECT_EQ(std::get<std::string>(values.at("kernel")), "cauchy");
  EXPECT_EQ(std::get<std::int64_t>(values.at("max-subdivisions")), 100);
  EXPECT_DOUBLE_EQ(std::get<double>(values.at("iso-level")), 0.1);
}

using formats::Case;
using formats::NodeOrigin;
using formats::Vec3f;
using formats::test::addBeads;
using formats::test::alongX;

/// A trunk of radius 2 along x, and an arm of radius 1 that leaves its middle obliquely, nodes 5 to 9,
/// which is bridged. The trunk's points, one to a node, are at its far side.
Case trunkAndArm() {
  Case value = formats::test::noBeads();
  addBeads(value, "trunk", alongX(-4, 2, 5), 2);
  addBeads(value, "arm",
           {{0, 1, 0}, {0.6F, 1.8F, 0}, {1.2F, 2.6F, 0}, {1.8F, 3.4F, 0}, {2.4F, 4.2F, 0}}, 1, 2);
  formats::PointSets points{{0}, {}};
  for (std::uint32_t node = 0; node < 10; ++node) {
    if (node < 5) points.position.push_back({value.tree.centre[node].x, -2, 0});
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
  }
  value.points = std::move(points);
  std::vector<NodeOrigin> origins(10, NodeOrigin::Measured);
  for (std::uint32_t node = 5; node < 10; ++node) origins[node] = NodeOrigin::Bridged;
  setNodeOrigins(value, origins);
  return value;
}

std::vector<std::vector<Vec3f>> pointsOf(const Case& value) {
  return pointsOfUnmeasured(value, formats::Neighbours(value.tree));
}

TEST(Unmeasured, NodesHaveARingOfPointsAcrossThem) {
  const auto points = pointsOf(trunkAndArm());
  ASSERT_EQ(points[9].size(), 16U);
  for (const Vec3f& p : points[9]) {
    EXPECT_NEAR(0.6 * (p.x - 2.4) + 0.8 * (p.y - 4.2), 0, 1e-6);
    EXPECT_NEAR(std::hypot(p.x - 2.4, p.y - 4.2, p.z), 1, 1e-6);
  }
}

TEST(Unmeasured, NodesHaveNoWallInAnotherBranchsLumen) {
  const auto points = pointsOf(trunkAndArm());
  EXPECT_TRUE(points[5].empty());   // all of it is in the trunk
  EXPECT_GE(points[6].size(), 1U);  // some of it is
  EXPECT_LT(points[6].size(), 16U);
  for (const Vec3f& p : points[6])
    for (const float x : {-2.0F, 0.0F, 2.0F}) EXPECT_GE(std::hypot(p.x - x, p.y, p.z), 2);
}

TEST(Unmeasured, NodesThatHavePointsKeepToThem) {
  Case value = trunkAndArm();
  value.points->position.push_back({3, 5, 0});
  ++value.points->offset.back();
  EXPECT_TRUE(pointsOf(value)[9].empty());
}

TEST(Unmeasured, MeasuredNodesGetNothing) {
  Case value = trunkAndArm();
  for (std::uint32_t node = 0; node < 5; ++node) EXPECT_TRUE(pointsOf(value)[node].empty());
  setNodeOrigins(value, std::vector<NodeOrigin>(10, NodeOrigin::Measured));
  for (const auto& points : pointsOf(value)) EXPECT_TRUE(points.empty());
}

}  // namespace
}  // namespace lumen::convert

namespace lumen::convert::fitting {
namespace {

using formats::Vec3d;

/// A blob in its node's centre whose surface has that radius.
Blob sphere(double radius) {
  const EnergyParameters p;
  return {0, 0, 0, formats::widthForRadius(p.kernel, p.kernelParameter, radius, p.isoLevel)};
}

TEST(Seam, OfTwoEqualSpheresIsTheirCircle) {
  const std::vector<Blob> model{sphere(1)};
  // centres 1.2 apart: the circle has the radius sqrt(1 - 0.6^2) = 0.8
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{1.2, 0, 0}, 1}, model}, {});
  ASSERT_EQ(seam.size(), kSeamRays);
  for (const Vec3d& p : seam) {
    EXPECT_NEAR(p.x, 0.6, 1e-12);
    EXPECT_NEAR(std::hypot(p.y, p.z), 0.8, 1e-4);
  }
}

TEST(Seam, LiesHalfwayBetweenTheSurfaces) {
  // both nodes are as wide as each other, but the second one's model is not
  const std::vector<Blob> first{sphere(1)}, second{sphere(std::sqrt(0.36 + 0.49))};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, first}, {{{1.2, 0, 0}, 1}, second}, {});
  ASSERT_EQ(seam.size(), kSeamRays);
  for (const Vec3d& p : seam) EXPECT_NEAR(std::hypot(p.y, p.z), 0.75, 1e-4);
}

TEST(Seam, LiesOnTheRadicalPlane) {
  const std::vector<Blob> wide{sphere(1)}, narrow{sphere(0.8)};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, wide}, {{{1, 0, 0}, 0.8}, narrow}, {});
  ASSERT_EQ(seam.size(), kSeamRays);
  // x^2 - 1 = (x - 1)^2 - 0.64
  for (const Vec3d& p : seam) EXPECT_NEAR(p.x, 0.68, 1e-12);
}

TEST(Seam, LeavesOutWhatBelongsToAnotherNode) {
  const std::vector<Blob> model{sphere(1)};
  const std::vector<FitBall> others{{{0.6, 1, 0}, 1}};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{1.2, 0, 0}, 1}, model}, others);
  ASSERT_FALSE(seam.empty());
  EXPECT_LT(seam.size(), kSeamRays);
  // nearer than the other node where y <= 0.32: (y - 1)^2 >= 0.36 + y^2
  for (const Vec3d& p : seam) EXPECT_LE(p.y, 0.32);
}

TEST(Seam, LeavesOutSurfacesThatAreFarApart) {
  const std::vector<Blob> narrow{sphere(1)}, wide{sphere(1.7)};
  const auto seam = seamPoints({}, {{{0, 0, 0}, 1}, narrow}, {{{1.2, 0, 0}, 1}, wide}, {});
  EXPECT_TRUE(seam.empty());
}

TEST(Seam, OfModelsThatDoNotReachThePlaneIsEmpty) {
  const std::vector<Blob> model{sphere(0.5)};
  EXPECT_TRUE(seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{1.2, 0, 0}, 1}, model}, {}).empty());
}

TEST(Seam, OfNodesInOnePlaceIsEmpty) {
  const std::vector<Blob> model{sphere(1)};
  EXPECT_TRUE(seamPoints({}, {{{0, 0, 0}, 1}, model}, {{{0, 0, 0}, 1}, model}, {}).empty());
}

}  // namespace
}  // namespace lumen::convert::fitting
