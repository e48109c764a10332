// SPDX-License-Identifier: Apache-2.0
// Organs: two systems of vessels, and the tissue around them, in Hounsfield units.
#include "converters/stages/phantom/organ.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/stages/phantom/phantom.h"
#include "formats/case/vessel_system.h"
#include "small_volume.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::VesselSystem;

PhantomOptions organ(const std::string& name) {
  PhantomOptions options;
  options.name = name;
  options.noise = options.bias = 0;
  return options;
}

Phantom made(const PhantomOptions& options) {
  Progress progress;
  return makePhantom(options, progress);
}

/// The mean of the voxels within two of a place, HU.
double around(const Phantom& phantom, const Vector3d& place) {
  double sum = 0;
  for (int z = -2; z <= 2; ++z)
    for (int y = -2; y <= 2; ++y)
      for (int x = -2; x <= 2; ++x)
        sum += voxelsOf(phantom)[phantom.volume.geometry.index(
            Cell(place.array().round().cast<int>()) + Cell(x, y, z))];
  return sum / 125;
}

TEST(Organs, HaveVoxelsOfAMillimetreAndTwoSystems) {
  for (const std::string& name : phantomNames()) {
    if (!isOrgan(name)) continue;
    const Phantom phantom = made(organ(name));
    EXPECT_EQ(phantom.volume.geometry.voxelSize(), 1) << name;
    EXPECT_EQ(phantom.volume.geometry.size[0], 112) << name;
    const auto systems = formats::readNodeSystems(phantom.truth);
    EXPECT_EQ(std::set(systems.begin(), systems.end()).size(), 2U) << name;
    EXPECT_EQ(std::count(systems.begin(), systems.end(), VesselSystem::Unknown), 0) << name;
    for (const formats::Branch& branch : phantom.truth.tree.branches)
      EXPECT_EQ(
          branch.label.rfind(
              std::string(formats::kVesselSystemNames[std::size_t(systems[branch.firstNode])]) +
                  "-",
              0),
          0U)
          << name << ' ' << branch.label;
  }
}

TEST(Organs, ShowTissueInHounsfieldUnits) {
  const Phantom heart = made(organ("heart"));
  EXPECT_NEAR(around(heart, {2, 2, 56}), -1000, 5);   // air
  EXPECT_NEAR(around(heart, {56, 52, 56}), 370, 5);   // ventricle
  EXPECT_NEAR(around(heart, {56, 20, 15}), 45, 5);    // muscle
  EXPECT_NEAR(around(heart, {56, 86, 30}), 180, 12);  // marrow
  const Phantom lungs = made(organ("lungs"));
  EXPECT_NEAR(around(lungs, {25, 44, 85}), -850, 10);
  EXPECT_NEAR(around(lungs, {56, 46, 30}), 365, 12);  // pulmonary artery, 4 mm in radius
}

TEST(Organs, ScaleWithTheVolume) {
  PhantomOptions half = organ("dissection");
  half.voxel = 0.5;
  const auto& whole = made(organ("dissection")).truth.tree;
  const auto& small = made(half).truth.tree;
  EXPECT_NEAR(small.radius[0] / whole.radius[0], 0.5F, 1e-6F);
  EXPECT_NEAR(small.centre[0].x / whole.centre[0].x, 0.5F, 1e-5F);
}

TEST(Organs, DoNotMove) {
  PhantomOptions moving = organ("liver");
  moving.motion = PhantomMotion::Heart;
  try {
    made(moving);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_NE(std::string(error.what()).find("'liver' would stand still"), std::string::npos);
  }
}

TEST(Organs, AVesselThatBeginsOnAnothersAxisHangsOnIt) {
  Organ two;
  two.systems = {{VesselSystem::Artery,
                  {courseThrough({{56, 56, 10}, {56, 56, 100}}, 3, 3),
                   courseThrough({{57, 56, 50}, {80, 56, 60}}, 2, 1),
                   courseThrough({{56, 59, 50}, {80, 80, 40}}, 2, 1)},
                  300}};
  const Design design = designOrgan(two, Frame{1, kOrganEdge});
  ASSERT_EQ(design.tree.branches.size(), 3U);
  EXPECT_GE(design.tree.branches[1].parentNode, 0);
  EXPECT_EQ(design.tree.branches[2].parentNode, formats::kNoParent);  // 3 mm away
  EXPECT_NEAR(design.contrast[0], 0.2F, 1e-6F);
}

TEST(Organs, ATreeDividesAndNarrows) {
  const Courses tree = forkingTree({0, 0, 0}, {0, 0, 2}, {20, 3, 2});
  ASSERT_EQ(tree.size(), 7U);
  EXPECT_NEAR(tree[0].back().position.z(), 20, 1e-9);
  EXPECT_NEAR(tree[1].front().radius, 0.79 * 3, 1e-9);
  EXPECT_NEAR((tree[1].back().position - tree[1].front().position).norm(), 15, 1e-9);
  const double angle = std::acos((tree[1].back().position - tree[1].front().position).z() / 15);
  EXPECT_NEAR(angle, 0.6, 0.121);
}

}  // namespace
}  // namespace lumen::convert
