// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/phantom/render.h"
#include "small_volume.h"

namespace lumen::convert {
namespace {

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

}  // namespace
}  // namespace lumen::convert
