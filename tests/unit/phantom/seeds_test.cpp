// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/phantom/design.h"
#include "converters/stages/phantom/phantom.h"

namespace lumen::convert {
namespace {

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
