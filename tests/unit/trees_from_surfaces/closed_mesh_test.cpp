// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/closed_mesh.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/repair/repair.h"
#include "tests/unit/trees_from_surfaces/tube_mesh.h"

namespace lumen::convert {
namespace {

TEST(ClosedMesh, HasAnEndForEachOpening) {
  const ClosedMesh closed = closeMesh(test::tube(test::straight(20), 2, false));
  ASSERT_EQ(closed.ends.size(), 2U);
  EXPECT_TRUE(closed.ends[0].wasOpen);
  EXPECT_NEAR(closed.ends[0].radius, 2, 0.02);
  EXPECT_NEAR(closed.ends[0].normal.x() * closed.ends[1].normal.x(), -1, 1e-9);
  EXPECT_EQ(eulerCharacteristic(closed.mesh), 2);
}

TEST(ClosedMesh, FindsFlatCaps) {
  const ClosedMesh closed = closeMesh(test::tube(test::straight(20), 2, true));
  ASSERT_EQ(closed.ends.size(), 2U);
  EXPECT_FALSE(closed.ends[0].wasOpen);
  EXPECT_NEAR(closed.ends[0].centre.x() + closed.ends[1].centre.x(), 20, 1e-9);
}

/// Surface of revolution round x of a profile of places and radii, the first and last of radius 0.
TriangleMesh turned(const std::vector<std::pair<double, double>>& profile) {
  constexpr std::uint32_t around = 32;
  TriangleMesh mesh;
  for (const auto& [x, radius] : profile)
    for (std::uint32_t k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.position.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
    }
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i)
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t a = i * around + k, b = i * around + (k + 1) % around;
      if (profile[i + 1].second > 0) mesh.triangle.push_back({a, b + around, a + around});
      if (profile[i].second > 0) mesh.triangle.push_back({a, b, b + around});
    }
  Progress progress;
  return repairMesh(mesh, "turned", progress).mesh;
}

/// A tube of radius 2 along x; its end at 0 is a half ball.
std::vector<std::pair<double, double>> roundStart() {
  std::vector<std::pair<double, double>> profile;
  for (int i = 0; i <= 16; ++i) {
    const double angle = std::numbers::pi / 2 * i / 16;
    profile.emplace_back(2 - 2 * std::cos(angle), 2 * std::sin(angle));
  }
  profile.front().second = 0;
  for (int i = 1; i <= 40; ++i) profile.emplace_back(2 + 0.5 * i, 2);
  return profile;
}

TEST(ClosedMesh, FindsACapWithASmoothedRim) {
  auto profile = roundStart();
  // bulges by 0.15, so that normals differ by up to 12 degrees
  profile.insert(profile.end(), {{22.2, 1.95}, {22.32, 1.8}, {22.4, 1.5}, {22.5, 0.8}, {22.55, 0}});
  const ClosedMesh closed = closeMesh(turned(profile));
  ASSERT_EQ(closed.ends.size(), 1U);
  EXPECT_FALSE(closed.ends[0].wasOpen);
  EXPECT_NEAR(closed.ends[0].centre.x(), 22.45, 0.1);
  EXPECT_NEAR(closed.ends[0].normal.x(), 1, 1e-6);
  EXPECT_NEAR(closed.ends[0].radius, 1.95, 0.06);  // the rim turns by 45 degrees there
}

TEST(ClosedMesh, SeesNoEndOnRoundAndPointedTips) {
  auto profile = roundStart();
  for (int i = 1; i <= 8; ++i) profile.emplace_back(22 + 0.5 * i, 2 - 0.25 * i);
  EXPECT_TRUE(closeMesh(turned(profile)).ends.empty());
}

TEST(ClosedMesh, TurnsWhatIsInsideOut) {
  TriangleMesh mesh = test::tube(test::straight(20), 2, true);
  for (Triangle& t : mesh.triangle) std::swap(t[0], t[1]);
  EXPECT_LT(signedVolume(mesh), 0);
  EXPECT_GT(signedVolume(closeMesh(mesh).mesh), 0);
}

TEST(ClosedMesh, SeesNoEndOnARing) {
  const ClosedMesh closed = closeMesh(test::ring(6, 2));
  EXPECT_TRUE(closed.ends.empty());
  EXPECT_EQ(eulerCharacteristic(closed.mesh), 0);
}

using Eigen::Vector3d;

TEST(TriangleTree, FindsTheWallOfATubeFromItsAxis) {
  const TriangleMesh mesh = test::tube(test::straight(20), 2, true, 64);
  const TriangleTree tree(mesh);
  const auto hit = tree.firstHit({10.1, 0, 0}, Vector3d::UnitY());
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->leaves);
  EXPECT_NEAR(hit->distance, 2, 0.003);  // 64 sides: 1 - cos(pi/64) of the radius
  const auto entering = tree.firstHit({10.1, 5, 0}, -Vector3d::UnitY());
  ASSERT_TRUE(entering);
  EXPECT_FALSE(entering->leaves);
  EXPECT_NEAR(tree.nearest({10, 1.5, 0}).distance, 0.5, 0.003);
}

TEST(TriangleTree, KnowsWhatATubeContains) {
  const TriangleMesh mesh = test::tube(test::straight(20), 2, true);
  const TriangleTree tree(mesh);
  EXPECT_TRUE(tree.contains({10, 1.9, 0}));
  EXPECT_FALSE(tree.contains({10, 2.1, 0}));
  EXPECT_FALSE(tree.contains({20.1, 0, 0}));
  EXPECT_FALSE(tree.isFree({10, 0, 0}, {10, 3, 0}));
  EXPECT_TRUE(tree.isFree({1, 0, 0}, {19, 0, 0}));
}

TEST(TriangleTree, FindsTheSameAsALookAtEveryTriangle) {
  const TriangleMesh mesh = test::ring(6, 2, 40, 12);
  const TriangleTree tree(mesh);
  for (int i = 0; i < 60; ++i) {
    const Vector3d from(std::sin(i * 1.7) * 9, std::cos(i * 2.3) * 9, std::sin(i * 0.9) * 3);
    double least = 1e9;
    for (const Triangle& t : mesh.triangle) {
      const TriangleMesh one{{mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]},
                             {{0, 1, 2}}};
      least = std::min(least, TriangleTree(one).nearest(from).distance);
    }
    EXPECT_EQ(tree.nearest(from).distance, least);
  }
}

}  // namespace
}  // namespace lumen::convert
