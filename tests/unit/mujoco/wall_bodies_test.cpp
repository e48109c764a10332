// SPDX-License-Identifier: Apache-2.0
// Bodies that carry pieces of a wall while its vessels move.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "../export/kissing.h"
#include "converters/export/targets/mujoco/wall_pieces.h"

namespace lumen::convert {

namespace {

constexpr double kAngle = 0.4;  // half of the turn about z

/// Two tubes along x that touch: one of a radius of 1 mm along y = 0, one of 0.6 mm at y = 1.6. At
/// one second the poses of `moving` are set.
formats::Case movingCase(const std::vector<std::uint32_t>& moving, double aside, bool isTurned) {
  formats::Case value = test::kissingCase(0);
  value.motion = formats::Motion{{0, 1}, 0, moving, {}};
  for (const double share : {0.0, 1.0})
    for (const std::uint32_t node : moving) {
      const formats::Vec3f& o = value.tree.centre[node];
      const double a = isTurned ? 2 * kAngle * share : 0;
      const auto x = static_cast<float>(std::cos(a) * o.x - std::sin(a) * o.y),
                 y = static_cast<float>(std::sin(a) * o.x + std::cos(a) * o.y + share * aside);
      value.motion->pose.push_back(
          {{x, y, o.z},
           {0, 0, static_cast<float>(std::sin(a / 2)), static_cast<float>(std::cos(a / 2))},
           1});
    }
  return value;
}

std::vector<std::uint32_t> nodes(std::uint32_t first, std::uint32_t last) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t n = first; n <= last; ++n) list.push_back(n);
  return list;
}

/// Triangles of the wall below and above the place where the tubes touch, about x = 10 mm, in m.
std::vector<WallFacet> bothWalls() {
  const auto facet = [](double y, double radius) {
    const auto at = [&](double x, double z) {
      return WallCorner{1e-3 * Eigen::Vector3d(x, y, z), 1e-3 * radius};
    };
    return WallFacet{at(9.5, 0), at(10.5, 0), at(10, 0.1)};
  };
  return {facet(-1, 1), facet(2.2, 0.6)};
}

TEST(WallBodies, OneBodyCarriesVesselsThatMoveAsOne) {
  const formats::Case value = movingCase(nodes(0, 31), 3, true);
  const WallBodies bodies(value);
  const RidingBody body = bodies.carrying(bothWalls());
  EXPECT_LT(body.misfit, 1e-4);
  ASSERT_EQ(body.turn.size(), 2U);
  EXPECT_NEAR(body.turn[0].angularDistance(Eigen::Quaterniond::Identity()), 0, 1e-5);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2 * kAngle, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(body.turn[1].angularDistance(turn), 0, 1e-5);
  const Eigen::Vector3d there = turn * body.centre + Eigen::Vector3d(0, 3e-3, 0);
  EXPECT_LT((body.place[1] - there).norm(), 1e-8);
}

TEST(WallBodies, NoBodyCarriesVesselsThatPart) {
  const formats::Case value = movingCase(nodes(0, 19), -1, false);
  const WallBodies bodies(value);
  EXPECT_GT(bodies.carrying(bothWalls()).misfit, 0.3);
  const std::vector<WallFacet> wide = {bothWalls().front()}, narrow = {bothWalls().back()};
  EXPECT_LT(bodies.carrying(wide).misfit, 1e-4);
  EXPECT_NEAR(bodies.carrying(wide).place[1].y(), -2e-3, 1e-7);
  EXPECT_NEAR(bodies.carrying(narrow).place[1].y(), 2.2e-3, 1e-7);
}

TEST(WallBodies, PiecesAreCutUntilARuleHolds) {
  SurfaceMesh mesh;
  mesh.groups = {{"wall", FaceKind::Wall}};
  for (int k = 0; k <= 400; ++k) {
    mesh.position.push_back({0.1F * static_cast<float>(k), static_cast<float>(k % 2), 0});
    mesh.normal.push_back({0, 0, 1});
    mesh.radius.push_back(1);
    mesh.branch.push_back(0);
  }
  for (std::uint32_t k = 0; k + 2 <= 400; ++k) {
    mesh.triangle.push_back({k, k + 1, k + 2});
    mesh.group.push_back(0);
  }
  const auto isShort = [](std::span<const WallFacet> piece) {
    double low = 1e9, high = -1e9;
    for (const WallFacet& facet : piece)
      for (const WallCorner& corner : facet) {
        low = std::min(low, corner.position.x());
        high = std::max(high, corner.position.x());
      }
    return high - low < 15;
  };
  EXPECT_EQ(cutIntoPieces(mesh, 1000, 1).size(), 1U);
  EXPECT_GE(cutIntoPieces(mesh, 1000, 1, isShort).size(), 3U);
}

TEST(WallBodies, KeyframesHoldPlacesAndTurnsOfAllBodies) {
  const formats::Case value = movingCase(nodes(0, 31), 1, false);
  const WallBodies bodies(value);
  const std::vector<RidingBody> riding = {bodies.carrying(Eigen::Vector3d(0.002, 0, 0)),
                                          bodies.carrying(Eigen::Vector3d(0.004, 0, 0))};
  const std::string text = bodies.keyframes(riding);
  EXPECT_NE(text.find("<key name=\"motion_0\" time=\"0\" mpos=\"0.002 0 0 0.004 0 0\" "
                      "mquat=\"1 0 0 0 1 0 0 0\"/>"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("<key name=\"motion_1\" time=\"1\" mpos=\"0.002 0.001 0 0.004 0.001 0\""),
            std::string::npos)
      << text;
}

}  // namespace

}  // namespace lumen::convert
