// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/closed_mesh.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/mesh_measures.h"
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

}  // namespace
}  // namespace lumen::convert
