// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/label_systems.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "converters/stages/trees_from_surfaces/branch_systems.h"
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "formats/case/validate.h"
#include "formats/case/vessel_system.h"
#include "tests/unit/trees_from_surfaces/drawn_labels.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::VesselSystem;
using test::away;
using test::LabelAt;
using Parts = std::vector<std::uint8_t>;

LabelMask masked(const LabelAt& label) {
  return makeLabelMask(test::drawn(Vector3d::Ones(), label), {}, "m.nrrd");
}

Parts partsOf(const LabelAt& label, std::vector<LabelRole> roles = {}) {
  const LabelMask mask = masked(label);
  roles.resize(mask.values.size(), LabelRole::Unknown);
  return partsOfLabels(mask, roles, Progress());
}

/// Two tubes side by side along x whose walls are `gap` apart, mm; below 0 the first label wins.
LabelAt sideBySide(double first, double second, double gap) {
  return [=](const Vector3d& p) {
    if (std::hypot(p.y() - 10.2, p.z() - 15.8) < first) return 1;
    return std::hypot(p.y() - 10.2 - first - second - gap, p.z() - 15.8) < second ? 2 : 0;
  };
}

TEST(LabelSystems, TubesThatTouchSideBySideAreApart) {
  for (const double first : {2.5, 3.0, 4.2})
    for (const double second : {2.5, 3.3, 4.2})
      for (const double gap : {-0.4, 0.0}) {
        if (gap < 0 && std::min(first, second) < 3) continue;  // as wide as it is deep
        EXPECT_EQ(partsOf(sideBySide(first, second, gap)), (Parts{0, 1}))
            << first << " " << second << " " << gap;
      }
}

TEST(LabelSystems, RolesOfOneSystemJoinWhatTouchesSideBySide) {
  const LabelAt touching = sideBySide(3, 3, 0);
  EXPECT_EQ(partsOf(touching, {LabelRole::Artery, LabelRole::Artery}), (Parts{0, 0}));
  EXPECT_EQ(partsOf(touching, {LabelRole::TrueLumen, LabelRole::Artery}), (Parts{0, 0}));
  EXPECT_EQ(partsOf(touching, {LabelRole::Artery, LabelRole::Vessel}), (Parts{0, 1}));
}

TEST(LabelSystems, TubesThatDoNotTouchAreOnePart) {
  EXPECT_EQ(partsOf(sideBySide(3, 3, 2), {LabelRole::Artery, LabelRole::Vein}), (Parts{0, 0}));
}

/// A tube along x, label 1 before x = 20, and 2 behind.
int endToEnd(const Vector3d& p) {
  if (std::hypot(p.y() - 15.8, p.z() - 16.1) > 3.3) return 0;
  return p.x() + 0.6 * p.y() < 30 ? 1 : 2;
}

TEST(LabelSystems, StretchesOfOneVesselAreOne) {
  EXPECT_EQ(partsOf(endToEnd), (Parts{0, 0}));
}

TEST(LabelSystems, ArteryAndVeinAreApartHoweverTheyTouch) {
  EXPECT_EQ(partsOf(endToEnd, {LabelRole::Artery, LabelRole::Vein}), (Parts{0, 1}));
  EXPECT_EQ(partsOf(endToEnd, {LabelRole::TrueLumen, LabelRole::FalseLumen}), (Parts{0, 1}));
  EXPECT_EQ(partsOf(endToEnd, {LabelRole::Artery, LabelRole::FalseLumen}), (Parts{0, 1}));
}

/// A branch of label 2 that leaves a tube of label 1 at an angle.
LabelAt branching(double degrees, double trunk, double branch) {
  const double angle = degrees * M_PI / 180;
  const Vector3d from(6, 12.3, 15.7),
      to = from + 60 * Vector3d(std::cos(angle), std::sin(angle), 0);
  return [=](const Vector3d& p) {
    if (std::hypot(p.y() - 12.3, p.z() - 15.7) < trunk) return 1;
    return away(p, from, to) < branch ? 2 : 0;
  };
}

TEST(LabelSystems, BranchesOfAnyAngleStayWithTheirVessel) {
  for (const double degrees : {25.0, 30.0, 40.0, 60.0, 90.0})
    for (const double trunk : {2.5, 4.0, 6.0})
      for (const double branch : {1.0, 1.5, 2.0, 3.0}) {
        if (branch > trunk) continue;
        EXPECT_EQ(partsOf(branching(degrees, trunk, branch)), (Parts{0, 0}))
            << degrees << " degrees, " << trunk << " " << branch;
      }
}

TEST(LabelSystems, ASacStaysWithItsVessel) {
  for (const double distance : {5.0, 6.0, 7.0})
    EXPECT_EQ(partsOf([=](const Vector3d& p) {
                if (std::hypot(p.y() - 9.2, p.z() - 15.8) < 2.6) return 1;
                return (p - Vector3d(19, 9.2 + distance, 15.8)).norm() < 5 ? 2 : 0;
              }),
              (Parts{0, 0}))
        << distance;
}

TEST(LabelSystems, ALabelBetweenTwoSystemsGoesWithTheGreaterFace) {
  // an unnamed stretch, 3, is one end of the artery, and only touches the vein
  const auto label = [](const Vector3d& p) {
    if (std::hypot(p.y() - 12.2, p.z() - 15.8) < 3) return p.x() < 20 ? 1 : 3;
    return std::hypot(p.y() - 18.1, p.z() - 15.8) < 3 && p.x() > 27 ? 2 : 0;
  };
  EXPECT_EQ(partsOf(label, {LabelRole::Artery, LabelRole::Vein, LabelRole::Unknown}),
            (Parts{0, 1, 0}));
}

/// The case of labels with these roles, part by part.
formats::Case treesOf(const LabelAt& label, const std::vector<LabelRole>& roles) {
  const LabelMask mask = masked(label);
  const Parts parts = partsOfLabels(mask, roles, Progress());
  formats::Case all;
  Progress progress;
  for (std::uint8_t part = 0; part <= *std::max_element(parts.begin(), parts.end()); ++part) {
    const LabelMask own = partOfMask(mask, parts, part);
    formats::Case made =
        caseOfLumen(closeMesh(makeLabelSurface(own, progress).mesh), 1, "m.nrrd", {}, {}, progress)
            .result;
    takeSystems(own, roles, made);
    if (part == 0)
      all = std::move(made);
    else
      appendTrees(made, all);
  }
  return all;
}

TEST(BranchSystems, PartsBecomeOneCaseOfTreesOfTheirOwn) {
  const formats::Case value = treesOf(sideBySide(4, 3, 0), {LabelRole::Artery, LabelRole::Vein});
  ASSERT_TRUE(formats::validate(value));
  ASSERT_EQ(value.tree.branches.size(), 2U);
  EXPECT_EQ(value.tree.branches[0].label, "vessel-1");
  EXPECT_EQ(value.tree.branches[1].label, "vessel-1-2");
  EXPECT_EQ(formats::readBranchSystems(value),
            (std::vector{VesselSystem::Artery, VesselSystem::Vein}));
  for (std::size_t n = 0; n < value.tree.nodeCount(); ++n)
    EXPECT_NEAR(value.tree.radius[n], value.tree.branch[n] == 0 ? 4 : 3, 0.3);
  EXPECT_EQ(value.points->offset.back(), value.points->position.size());
}

TEST(BranchSystems, SpreadAlongATreeAndNoFarther) {
  // a trunk, its child with a child, and a tree of its own
  formats::Case value;
  for (const std::int32_t parent : {-1, 0, 1, -1}) {
    formats::Branch branch;
    branch.label = std::string(1, static_cast<char>('a' + value.tree.branches.size()));
    branch.parentNode = parent;
    branch.firstNode = static_cast<std::uint32_t>(value.tree.nodeCount());
    branch.nodeCount = 1;
    value.tree.branch.push_back(static_cast<std::uint32_t>(value.tree.branches.size()));
    value.tree.centre.push_back({});
    value.tree.radius.push_back(2);
    value.tree.branches.push_back(branch);
  }
  constexpr VesselSystem kNone = VesselSystem::Unknown, kVein = VesselSystem::Vein;
  for (const std::size_t known : {0U, 1U, 2U}) {
    std::vector<VesselSystem> systems(4, kNone);
    systems[known] = kVein;
    formats::setNodeSystems(value, systems);
    spreadSystems(value);
    EXPECT_EQ(formats::readBranchSystems(value), (std::vector{kVein, kVein, kVein, kNone}));
  }
  formats::setNodeSystems(value, {VesselSystem::TrueLumen, kNone, VesselSystem::Artery, kNone});
  spreadSystems(value);
  EXPECT_EQ(
      formats::readBranchSystems(value),
      (std::vector{VesselSystem::TrueLumen, VesselSystem::Artery, VesselSystem::Artery, kNone}));
  value.tree.radius[1] = 2.6F;  // a chamber between two vessels
  formats::setNodeSystems(value, {kVein, kNone, kNone, kNone});
  spreadSystems(value);
  EXPECT_EQ(formats::readBranchSystems(value), (std::vector{kVein, kNone, kNone, kNone}));
}

}  // namespace
}  // namespace lumen::convert
