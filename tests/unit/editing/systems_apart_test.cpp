// SPDX-License-Identifier: Apache-2.0
// Vessels of unlike systems, which no topology joins, and which edits keep.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/stages/editing/correct_topology.h"
#include "converters/stages/editing/edit.h"
#include "formats/case/node_origin.h"
#include "formats/case/validate.h"
#include "formats/case/vessel_system.h"
#include "unit/formats/beads.h"

namespace lumen::convert {
namespace {

using formats::VesselSystem;

/// Beads every half millimetre from one place to another.
void addVessel(formats::Case& value, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               float radius, std::int32_t parent = formats::kNoParent) {
  std::vector<formats::Vec3f> places;
  const double count = std::floor((to - from).norm() / 0.5);
  for (double i = 0; i <= count; ++i) places.push_back(toVec3f(from + i / count * (to - from)));
  formats::test::addBeads(value, "v" + std::to_string(value.tree.branches.size()), places, radius,
                          parent);
  value.models.reset();
}

/// The case, each of whose branches has a system.
formats::Case ofSystems(formats::Case value, const std::vector<VesselSystem>& systems) {
  std::vector<VesselSystem> nodes;
  for (const std::uint32_t branch : value.tree.branch) nodes.push_back(systems[branch]);
  formats::setNodeSystems(value, nodes);
  return value;
}

constexpr VesselSystem kRed = VesselSystem::Artery, kBlue = VesselSystem::Vein;

std::size_t countTrees(const formats::Case& value) {
  const auto& branches = value.tree.branches;
  return static_cast<std::size_t>(std::count_if(branches.begin(), branches.end(),
                                                [](const auto& b) { return b.parentNode < 0; }));
}

/// Trees of two vessels after correction, of one system and of two, in lumen or out of it.
std::pair<std::size_t, std::size_t> treesOf(const formats::Case& value, bool isLumen) {
  const LumenInVolume around{[=](const Eigen::Vector3d&) { return isLumen; },
                             [](const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() < 30; }};
  formats::Case one = ofSystems(value, {kRed, VesselSystem::TrueLumen}),
                two = ofSystems(value, {kRed, kBlue});
  correctTopology(one, around);
  correctTopology(two, around);
  EXPECT_TRUE(formats::validate(two));
  const std::vector<VesselSystem> systems = formats::readBranchSystems(two);
  EXPECT_EQ(std::count(systems.begin(), systems.end(), kRed), 1);
  EXPECT_EQ(std::count(systems.begin(), systems.end(), kBlue), 1);
  return {countTrees(one), countTrees(two)};
}

TEST(SystemsApart, EndsThatFaceOneAnotherAreJoinedWithinASystemAlone) {
  formats::Case value = formats::test::noBeads();
  addVessel(value, {-10, 0, 0}, {-2, 0, 0}, 1);
  addVessel(value, {10, 0, 0}, {2, 0, 0}, 0.9F);
  EXPECT_EQ(treesOf(value, true), (std::pair<std::size_t, std::size_t>{1, 2}));
}

TEST(SystemsApart, VoidsAreBridgedWithinASystemAlone) {
  formats::Case value = formats::test::noBeads();
  addVessel(value, {-12.5, 0, 0}, {-2.5, 0, 0}, 1);
  addVessel(value, {12.5, 0, 0}, {2.5, 0, 0}, 1.1F);
  EXPECT_EQ(treesOf(value, false), (std::pair<std::size_t, std::size_t>{1, 2}));
}

TEST(SystemsApart, TracksThatOverlapAreOneWithinASystemAlone) {
  formats::Case value = formats::test::noBeads();
  addVessel(value, {-10, 0, 0}, {2, 0, 0}, 1);
  addVessel(value, {10, 0.2, 0}, {-2, 0.2, 0}, 0.9F);
  EXPECT_EQ(treesOf(value, true), (std::pair<std::size_t, std::size_t>{1, 2}));
}

TEST(SystemsApart, AnEndJoinsASideWithinASystemAlone) {
  formats::Case value = formats::test::noBeads();
  addVessel(value, {-10, 0, 0}, {10, 0, 0}, 1);
  addVessel(value, {0, 12, 0}, {0, 2, 0}, 0.7F);
  EXPECT_EQ(treesOf(value, true), (std::pair<std::size_t, std::size_t>{1, 2}));
}

TEST(SystemsApart, ABranchOfAnotherSystemLosesItsParentAndTheBridgeToIt) {
  formats::Case value = formats::test::noBeads();
  addVessel(value, {-10, 0, 0}, {10, 0, 0}, 1);
  addVessel(value, {0, 0.5, 0}, {0, 12, 0}, 0.7F, 20);
  std::vector<formats::NodeOrigin> origins(value.tree.nodeCount(), formats::NodeOrigin::Measured);
  origins[41] = origins[42] = formats::NodeOrigin::Bridged;
  formats::setNodeOrigins(value, origins);
  const std::size_t before = value.tree.nodeCount();
  EXPECT_EQ(treesOf(value, true), (std::pair<std::size_t, std::size_t>{1, 2}));
  formats::Case two = ofSystems(value, {kRed, kBlue});
  correctTopology(two, {[](const auto&) { return true; }, [](const auto&) { return true; }});
  EXPECT_EQ(two.tree.nodeCount(), before - 2);
}

TEST(SystemsApart, APersonMayJoinThemAndNewNodesAreOfTheVesselThatIsJoined) {
  formats::Case value = formats::test::noBeads();
  addVessel(value, {-10, 0, 0}, {10, 0, 0}, 1);
  addVessel(value, {0, 5, 0}, {0, 12, 0}, 0.7F);
  value = ofSystems(value, {kRed, kBlue});
  const std::size_t before = value.tree.nodeCount();
  const Change change = joinBranch(value, 1, 20);
  EXPECT_GT(value.tree.nodeCount(), before);
  EXPECT_TRUE(change.droppedArrays.empty());
  const std::vector<VesselSystem> nodes = formats::readNodeSystems(value);
  EXPECT_EQ(std::count(nodes.begin(), nodes.end(), kRed), 41);
  EXPECT_EQ(std::count(nodes.begin(), nodes.end(), kBlue),
            static_cast<std::ptrdiff_t>(nodes.size()) - 41);
}

}  // namespace
}  // namespace lumen::convert
