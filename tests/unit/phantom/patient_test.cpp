// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 0.2;
const Frame kLarge{kVoxel, 511 * kVoxel}, kDefault{kVoxel, 255 * kVoxel};

Design make(const Frame& frame, std::uint64_t seed) {
  Progress progress;
  return designPatient(frame, seed, progress);
}

double radius(const formats::CenterlineTree& tree, std::uint32_t node) {
  return static_cast<double>(tree.radius[node]);
}

int parentOf(const formats::CenterlineTree& tree, std::size_t branch) {
  const std::int32_t node = tree.branches[branch].parentNode;
  return node < 0 ? -1 : static_cast<int>(tree.branch[static_cast<std::size_t>(node)]);
}

std::pair<std::string, std::string> kissingPair(const Design& design) {
  std::istringstream text(std::get<std::string>(design.notes.at("kissing")));
  std::pair<std::string, std::string> pair;
  text >> pair.first >> pair.second;
  return pair;
}

// The clearance of each node of `branch` from another one's wall, mm.
std::vector<double> clearances(const formats::CenterlineTree& tree, std::size_t branch,
                               const TubeTreeDistance& wall) {
  std::vector<double> result;
  const formats::Branch& b = tree.branches[branch];
  for (std::uint32_t n = b.firstNode; n < b.firstNode + b.nodeCount; ++n)
    result.push_back(wall.nearest(toEigen(tree.centre[n])).distance - radius(tree, n));
  return result;
}

TEST(PatientPhantom, HasFortyBranchesOfWhichOneIsAnAneurysm) {
  const formats::CenterlineTree tree = make(kLarge, 1).tree;
  EXPECT_EQ(tree.branches.size(), 40U);
  EXPECT_EQ(std::count_if(
                tree.branches.begin(), tree.branches.end(),
                [](const formats::Branch& b) { return b.kind == formats::BranchKind::Aneurysm; }),
            1);
}

TEST(PatientPhantom, VesselRadiiReachFrom2Point2To0Point25) {
  const formats::CenterlineTree tree = make(kLarge, 1).tree;
  double low = 1e9, high = 0;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    if (tree.branches[tree.branch[n]].kind == formats::BranchKind::Aneurysm) continue;
    low = std::min(low, radius(tree, n));
    high = std::max(high, radius(tree, n));
  }
  EXPECT_NEAR(low, 0.25, 1e-6);
  EXPECT_NEAR(high, 2.2, 1e-6);
}

TEST(PatientPhantom, BranchesThatAreNotJoinedAreTwoVoxelsApartButForTheKissingPair) {
  for (const Frame& frame : {kLarge, kDefault}) {
    const Design design = make(frame, 3);
    const formats::CenterlineTree& tree = design.tree;
    const auto kissing = kissingPair(design);
    for (std::uint32_t b = 0; b < tree.branches.size(); ++b) {
      const TubeTreeDistance wall(tree, b);
      for (std::size_t a = b + 1; a < tree.branches.size(); ++a) {
        if (parentOf(tree, a) == static_cast<int>(b) || parentOf(tree, b) == static_cast<int>(a))
          continue;
        if (tree.branches[b].label == kissing.first && tree.branches[a].label == kissing.second)
          continue;
        const std::vector<double> apart = clearances(tree, a, wall);
        EXPECT_GE(*std::min_element(apart.begin(), apart.end()), 2 * kVoxel)
            << tree.branches[a].label << " " << tree.branches[b].label;
      }
    }
  }
}

TEST(PatientPhantom, AChildThatHasLeftItsParentDoesNotTouchItAgain) {
  const formats::CenterlineTree tree = make(kLarge, 3).tree;
  for (std::size_t b = 1; b < tree.branches.size(); ++b) {
    if (tree.branches[b].kind == formats::BranchKind::Aneurysm) continue;
    const std::vector<double> apart =
        clearances(tree, b, TubeTreeDistance(tree, static_cast<std::uint32_t>(parentOf(tree, b))));
    const auto left =
        std::find_if(apart.begin(), apart.end(), [](double c) { return c >= 2.5 * kVoxel; });
    ASSERT_NE(left, apart.end());
    EXPECT_GE(*std::min_element(left, apart.end()), 2 * kVoxel) << tree.branches[b].label;
  }
}

TEST(PatientPhantom, TheKissingPairTouchesOverTenMillimetresAndParts) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Design design = make(kDefault, seed);
    const auto [first, second] = kissingPair(design);
    std::size_t host = 0, partner = 0;
    for (std::size_t b = 0; b < design.tree.branches.size(); ++b) {
      if (design.tree.branches[b].label == first) host = b;
      if (design.tree.branches[b].label == second) partner = b;
    }
    const std::vector<double> apart = clearances(
        design.tree, partner, TubeTreeDistance(design.tree, static_cast<std::uint32_t>(host)));
    const auto touching =
        std::count_if(apart.begin(), apart.end(), [](double c) { return c < 0.25 * kVoxel; });
    EXPECT_GT(0.1 * static_cast<double>(touching), 10);
    EXPECT_GT(*std::min_element(apart.begin(), apart.end()), -0.2 * kVoxel);
    EXPECT_GT(apart.back(), 2 * kVoxel);
  }
}

TEST(PatientPhantom, TheWallStaysInsideTheVolumeButWhereTheRootEnters) {
  const formats::CenterlineTree tree = make(kDefault, 2).tree;
  EXPECT_EQ(toEigen(tree.centre[0]).z(), 0);
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    const Vector3d centre = toEigen(tree.centre[n]);
    if (tree.branch[n] == 0 && centre.z() < 10) continue;
    EXPECT_GE(centre.minCoeff() - radius(tree, n), 4 * kVoxel);
    EXPECT_LE(centre.maxCoeff() + radius(tree, n), kDefault.extent - 4 * kVoxel);
  }
}

TEST(PatientPhantom, NoVesselBendsMoreTightlyThanTwoAndAHalfRadii) {
  const formats::CenterlineTree tree = make(kLarge, 4).tree;
  for (const formats::Branch& b : tree.branches) {
    if (b.kind == formats::BranchKind::Aneurysm) continue;
    for (std::uint32_t n = b.firstNode + 5; n + 5 < b.firstNode + b.nodeCount; ++n) {
      const Vector3d before = toEigen(tree.centre[n]) - toEigen(tree.centre[n - 5]);
      const Vector3d after = toEigen(tree.centre[n + 5]) - toEigen(tree.centre[n]);
      const double turn = std::atan2(before.cross(after).norm(), before.dot(after));
      EXPECT_LT(turn * 2.5 * radius(tree, n), 0.5 * (before.norm() + after.norm())) << b.label;
    }
  }
}

TEST(PatientPhantom, AChildLeavesAt30To80DegreesWithHalfTo85PerCentOfTheRadius) {
  const formats::CenterlineTree tree = make(kLarge, 5).tree;
  for (const formats::Branch& b : tree.branches) {
    if (b.parentNode < 0 || b.kind == formats::BranchKind::Aneurysm) continue;
    const auto parent = static_cast<std::uint32_t>(b.parentNode);
    const double cosine = toEigen(tree.direction[parent]).dot(toEigen(tree.direction[b.firstNode]));
    EXPECT_GT(cosine, std::cos(81 * 3.14159265 / 180)) << b.label;
    EXPECT_LT(cosine, std::cos(29 * 3.14159265 / 180)) << b.label;
    const double share = radius(tree, b.firstNode) / radius(tree, parent);
    EXPECT_GT(share, 0.49) << b.label;
    EXPECT_LT(share, 0.86) << b.label;
  }
}

TEST(PatientPhantom, IsTheSameForTheSameSeedAndAnotherForAnother) {
  EXPECT_EQ(make(kDefault, 7).tree, make(kDefault, 7).tree);
  EXPECT_FALSE(make(kDefault, 7).tree == make(kDefault, 8).tree);
}

TEST(PatientPhantom, SucceedsForTwentySeedsAtBothSizes) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(make(kDefault, seed).tree.branches.size(), 40U);
    EXPECT_EQ(make(kLarge, seed).tree.branches.size(), 40U);
  }
}

using Eigen::Vector3d;

struct Clicked {
  formats::CenterlineTree tree;
  std::vector<SeedBranch> seeds;
};

// Every phantom of two random seeds.
std::vector<Clicked> allClicked() {
  std::vector<Clicked> all;
  Progress progress;
  const Frame small{0.2, 25.4}, large{0.2, 51};
  for (const std::uint64_t seed : {1U, 2U}) {
    for (const auto& make : {designTube, designHelix, designBifurcation, designKissing,
                             designAneurysm, designStenosis, designDropout}) {
      Random random(seed);
      Clicked clicked{make(small).tree, {}};
      clicked.seeds = clickSeeds(clicked.tree, random);
      all.push_back(clicked);
    }
    Random random(seed);
    Clicked patient{designPatient(large, seed, progress).tree, {}};
    patient.seeds = clickSeeds(patient.tree, random);
    all.push_back(patient);
  }
  return all;
}

const formats::Branch& branchOf(const Clicked& clicked, const std::string& label) {
  return *std::find_if(clicked.tree.branches.begin(), clicked.tree.branches.end(),
                       [&](const formats::Branch& b) { return b.label == label; });
}

TEST(PhantomSeeds, ThereIsOneForEachBranchWithItsLabelKindAndParentsFirst) {
  for (const Clicked& clicked : allClicked()) {
    ASSERT_EQ(clicked.seeds.size(), clicked.tree.branches.size());
    std::vector<std::string> before;
    for (const SeedBranch& seed : clicked.seeds) {
      EXPECT_EQ(seed.kind, branchOf(clicked, seed.label).kind);
      if (seed.parent) {
        EXPECT_NE(std::find(before.begin(), before.end(), *seed.parent), before.end());
      }
      EXPECT_EQ(seed.parent.has_value(),
                branchOf(clicked, seed.label).parentNode != formats::kNoParent);
      before.push_back(seed.label);
    }
  }
}

TEST(PhantomSeeds, EveryPointLiesWithinTheLumenOfItsBranch) {
  for (const Clicked& clicked : allClicked())
    for (std::uint32_t b = 0; b < clicked.seeds.size(); ++b)
      for (const SeedPoint& point : clicked.seeds[b].points) {
        const TubeTreeDistance lumen(clicked.tree, b);
        const WallHit hit = lumen.nearest(point.position);
        EXPECT_LT(hit.distance, -0.45 * static_cast<double>(clicked.tree.radius[hit.node]))
            << clicked.seeds[b].label;
      }
}

TEST(PhantomSeeds, ARootHasARadiusWithinTenPerCentAndADirectionWithinTenDegrees) {
  for (const Clicked& clicked : allClicked())
    for (const SeedBranch& seed : clicked.seeds) {
      if (seed.parent) continue;
      const formats::Branch& branch = branchOf(clicked, seed.label);
      const double radius = static_cast<double>(clicked.tree.radius[branch.firstNode]);
      EXPECT_NEAR(*seed.points[0].radius, radius, 0.1 * radius);
      const Vector3d along = toEigen(clicked.tree.direction[branch.firstNode]);
      EXPECT_GT(seed.direction->dot(along), 0.96);  // the helix bends a little up to the click
      EXPECT_NEAR(seed.direction->norm(), 1, 1e-12);
    }
}

TEST(PhantomSeeds, AChildIsClickedBetweenOneAndTwoAndAHalfParentRadiiFromTheParentsAxis) {
  for (const Clicked& clicked : allClicked())
    for (const SeedBranch& seed : clicked.seeds) {
      if (!seed.parent || seed.kind == formats::BranchKind::Aneurysm) continue;
      const auto parentNode = static_cast<std::uint32_t>(branchOf(clicked, seed.label).parentNode);
      const double parentRadius = static_cast<double>(clicked.tree.radius[parentNode]);
      const formats::Branch& parent = branchOf(clicked, *seed.parent);
      double nearest = 1e9;
      for (std::uint32_t n = parent.firstNode; n < parent.firstNode + parent.nodeCount; ++n)
        nearest =
            std::min(nearest, (toEigen(clicked.tree.centre[n]) - seed.points[0].position).norm());
      EXPECT_GT(nearest, 1.25 * parentRadius) << seed.label;
      EXPECT_LT(nearest, 2.5 * parentRadius) << seed.label;
    }
}

TEST(PhantomSeeds, AnAneurysmsPointsGoOutwardsWithTheirDistanceToTheWall) {
  Random random(1);
  const formats::CenterlineTree tree = designAneurysm(Frame{0.2, 25.4}).tree;
  const std::vector<SeedPoint> points = clickSeeds(tree, random)[1].points;
  const TubeTreeDistance lumen(tree, 1);
  ASSERT_EQ(points.size(), 3U);
  for (const SeedPoint& point : points) {
    const double depth = -lumen.nearest(point.position).distance;
    EXPECT_NEAR(*point.radius, depth, 0.25 * depth);
  }
  EXPECT_LT(points[0].position.x(), points[1].position.x());
  EXPECT_LT(points[1].position.x(), points[2].position.x());
}

}  // namespace
}  // namespace lumen::convert
