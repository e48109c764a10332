// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/label_mesh.h"

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "tests/unit/trees_from_surfaces/drawn_labels.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

using test::away;
using test::drawn;

TEST(LabelMesh, GreyValuesAreToldFromLabels) {
  const auto grey = [](const Vector3d& p) {
    return 100 + static_cast<int>(50 * (std::sin(2 * p.x()) + std::sin(3 * p.y() + p.z())));
  };
  const auto labels = [](const Vector3d& p) { return 1 + static_cast<int>(p.x() / 4); };
  EXPECT_FALSE(holdsLabels(drawn({1, 1, 1}, grey)));
  EXPECT_FALSE(holdsLabels(drawn({1, 1, 1}, [](const Vector3d&) { return 0; })));
  EXPECT_TRUE(
      holdsLabels(drawn({1, 1, 1}, [](const Vector3d& p) { return static_cast<int>(p.x() / 4); })));
  EXPECT_TRUE(makeLabelMask(drawn({1, 1, 1}, grey), {}, "m.nrrd").isGrey);
  EXPECT_FALSE(makeLabelMask(drawn({1, 1, 1}, labels), {}, "m.nrrd").isGrey);
}

TEST(LabelMesh, LiesOnTheWallOfATubeWhateverTheSpacing) {
  for (const Vector3d& spacing : {Vector3d(0.5, 0.5, 0.5), Vector3d(0.5, 0.4, 0.8)}) {
    const Vector3d a = spacing.cwiseProduct(Vector3d(8, 15, 13)),
                   b = spacing.cwiseProduct(Vector3d(31, 17.3, 18.6));
    const double radius = 2.4;
    const Volume volume =
        drawn(spacing, [&](const Vector3d& p) { return away(p, a, b) < radius ? 1 : 0; });
    Progress progress;
    const LabelSurface surface = makeLabelSurface(makeLabelMask(volume, {}, "m.nrrd"), progress);
    EXPECT_EQ(eulerCharacteristic(surface.mesh), 2);
    double sum = 0;
    for (const Vector3d& p : surface.mesh.position) {
      const Vector3d at = spacing.cwiseProduct(volume.geometry.indexFromWorld(p));
      EXPECT_LT(std::abs(away(at, a, b) - radius), 0.5 * spacing.maxCoeff());
      sum += away(at, a, b) - radius;
    }
    // by a hundredth of a voxel or two; plain smoothing moves it by four
    EXPECT_NEAR(sum / static_cast<double>(surface.mesh.position.size()), 0, 0.012);
    const double length = (b - a).norm();
    // its triangles, up to a voxel and a half long, are chords
    EXPECT_NEAR(signedVolume(surface.mesh) /
                    (std::numbers::pi * radius * radius * (length + 4 * radius / 3)),
                1, 0.03);
  }
}

TEST(LabelMesh, IsFlatWhereTheVolumeCutsAVesselOff) {
  const Volume volume = drawn(Vector3d::Ones(), [](const Vector3d& p) {
    return std::hypot(p.y() - 15.2, p.z() - 16.1) < 4 ? 1 : 0;
  });
  Progress progress;
  const ClosedMesh closed =
      closeMesh(makeLabelSurface(makeLabelMask(volume, {}, "m.nrrd"), progress).mesh);
  ASSERT_EQ(closed.ends.size(), 2U);
  for (const MeshEnd& end : closed.ends) {
    const double x = volume.geometry.indexFromWorld(end.centre).x();
    EXPECT_TRUE(end.wasOpen);
    EXPECT_NEAR(std::abs(x - 19.5), 20, 1e-6);  // half a voxel beyond the centres of the last
    EXPECT_NEAR(end.radius, 4, 0.1);
  }
}

TEST(LabelMesh, KeepsWhatIsOneVoxelWide) {
  const Volume volume = drawn(Vector3d::Ones(), [](const Vector3d& p) {
    return p.y() == 15 && p.z() == 16 && p.x() > 5 && p.x() < 30 ? 1 : 0;
  });
  Progress progress;
  const LabelSurface surface = makeLabelSurface(makeLabelMask(volume, {}, "m.nrrd"), progress);
  EXPECT_EQ(eulerCharacteristic(surface.mesh), 2);
  EXPECT_GT(signedVolume(surface.mesh), 0);
}

TEST(LabelMesh, KeepsTheWidthOfWhatIsOneVoxelWide) {
  const Volume volume = drawn(Vector3d::Ones(), [](const Vector3d& p) {
    return p.y() == 15 && p.z() == 16 && p.x() > 5 && p.x() < 30 ? 1 : 0;
  });
  Progress progress;
  const LabelSurface surface = makeLabelSurface(makeLabelMask(volume, {}, "m.nrrd"), progress);
  EXPECT_GT(signedVolume(surface.mesh), 0.3 * 24);  // a third of what was drawn
}

TEST(LabelMesh, HoldsTogetherALineOfVoxelsThatMeetAtCorners) {
  const Volume volume = drawn(Vector3d::Ones(), [](const Vector3d& p) {
    return p.x() > 5 && p.x() < 25 && p.y() == p.x() && p.z() == p.x() ? 1 : 0;
  });
  Progress progress;
  const LabelSurface surface = makeLabelSurface(makeLabelMask(volume, {}, "m.nrrd"), progress);
  EXPECT_EQ(eulerCharacteristic(surface.mesh), 2);
}

TEST(LabelMesh, FillsHoles) {
  const Volume volume = drawn(Vector3d::Ones(), [](const Vector3d& p) {
    const double from = (p - Vector3d(20, 15, 15)).norm();
    return from < 9 && from > 3 ? 1 : 0;
  });
  Progress progress;
  const LabelSurface surface = makeLabelSurface(makeLabelMask(volume, {}, "m.nrrd"), progress);
  EXPECT_EQ(surface.cavities, 1U);
  EXPECT_EQ(eulerCharacteristic(surface.mesh), 2);
}

/// A trunk of label 3 whose two arms are of labels 5 and 7.
Volume fork() {
  const Vector3d a(-5, 16, 16), b(18, 16, 16), c(45, 4, 16), d(45, 28, 16);
  return drawn(Vector3d::Ones(), [=](const Vector3d& p) {
    if (away(p, a, b) < 4) return 3;
    if (away(p, b, c) < 2.6) return 5;
    return away(p, b, d) < 2.6 ? 7 : 0;
  });
}

TEST(LabelMesh, NamesBranchesByTheirLabels) {
  Progress progress;
  const LabelMask mask = makeLabelMask(fork(), {{5, "left"}, {7, "right"}, {3, "trunk"}}, "m.nrrd");
  formats::Case value =
      caseOfLumen(closeMesh(makeLabelSurface(mask, progress).mesh), 0, "m.nrrd", {}, {}, progress)
          .result;
  ASSERT_EQ(value.tree.branches.size(), 2U);
  nameBranches(mask, value);
  // the path through the trunk goes on through one of the arms and is divided there, the other arm is
  // a branch of its own
  ASSERT_EQ(value.tree.branches.size(), 3U);
  std::set<std::string> labels;
  for (const formats::Branch& branch : value.tree.branches) labels.insert(branch.label);
  EXPECT_EQ(labels, (std::set<std::string>{"left", "right", "trunk"}));
}

TEST(LabelMesh, TakesTheChosenLabelAlone) {
  Progress progress;
  const LabelMask mask = makeLabelMask(fork(), {{3, "trunk"}}, "m.nrrd");
  const formats::Case value =
      caseOfLumen(closeMesh(makeLabelSurface(mask, progress).mesh), 0, "m.nrrd", {}, {}, progress)
          .result;
  EXPECT_EQ(value.tree.branches.size(), 1U);
}

TEST(LabelMesh, RefusesLabelsThatAreNotThere) {
  try {
    makeLabelMask(fork(), {{4, "x"}}, "m.nrrd");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_STREQ(error.what(), "m.nrrd: no voxel has the label 4; it has 3, 5, 7");
  }
}

TEST(LabelMesh, RefusesAnImage) {
  Volume image = fork();
  std::vector<float> voxels(image.geometry.voxelCount());
  for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = 0.25F * static_cast<float>(i % 7);
  image.voxels = voxels;
  EXPECT_THROW(makeLabelMask(image, {}, "m.nrrd"), Error);
  std::vector<std::uint16_t> many(image.geometry.voxelCount());
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<std::uint16_t>(i % 1000);
  image.voxels = many;
  EXPECT_THROW(makeLabelMask(image, {}, "m.nrrd"), Error);
  // but one of many labels can be chosen
  EXPECT_EQ(makeLabelMask(image, {{999, "x"}}, "m.nrrd").label[999], 1);
}

TEST(LabelMesh, IsTheSameOnAnyNumberOfThreads) {
  Progress progress;
  const LabelMask mask = makeLabelMask(fork(), {}, "m.nrrd");
  const TriangleMesh many = makeLabelSurface(mask, progress).mesh;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TriangleMesh alone = makeLabelSurface(mask, progress).mesh;
  EXPECT_EQ(alone.position, many.position);
  EXPECT_EQ(alone.triangle, many.triangle);
}

}  // namespace
}  // namespace lumen::convert
