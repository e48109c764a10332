// SPDX-License-Identifier: Apache-2.0
// Bodies that carry pieces of a wall while its vessels move.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "../export/kissing.h"
#include "converters/export/targets/cathsim/wall_prisms.h"
#include "converters/export/targets/mujoco/wall_pieces.h"
#include "converters/export/targets/mujoco/wire.h"

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

// A surface in pieces for MuJoCo's distance fields, and as prisms for CathSim.
constexpr int kSides = 24, kRings = 40;
constexpr double kRadius = 1, kLength = 20;

/// An open tube along x, normals outwards.
SurfaceMesh tube() {
  SurfaceMesh mesh;
  mesh.groups = {{"wall", FaceKind::Wall}};
  for (int ring = 0; ring <= kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const double a = 2 * std::numbers::pi * side / kSides;
      mesh.position.push_back({static_cast<float>(kLength * ring / kRings),
                               static_cast<float>(kRadius * std::cos(a)),
                               static_cast<float>(kRadius * std::sin(a))});
      mesh.normal.push_back({0, static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a))});
      mesh.radius.push_back(kRadius);
      mesh.branch.push_back(0);
    }
  const auto at = [](int ring, int side) {
    return static_cast<std::uint32_t>(ring * kSides + side % kSides);
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int side = 0; side < kSides; ++side) {
      mesh.triangle.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side)});
      mesh.triangle.push_back({at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)});
    }
  mesh.group.assign(mesh.triangle.size(), 0);
  return mesh;
}

Eigen::Vector3d corner(const SurfaceMesh& mesh, std::uint32_t v) {
  const Float3& p = mesh.position[v];
  return {p[0], p[1], p[2]};
}

Eigen::Vector3d areaOf(const SurfaceMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d o = corner(mesh, t[0]);
  return (corner(mesh, t[1]) - o).cross(corner(mesh, t[2]) - o) / 2;
}

double areaOf(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangle) sum += areaOf(mesh, t).norm();
  return sum;
}

bool isInTube(const Float3& p) {
  return std::hypot(p[1], p[2]) < kRadius * 0.9;
}

TEST(WallPieces, ASurfaceThatFitsIsLeftAsItIs) {
  const SurfaceMesh mesh = tube();
  const auto pieces = cutIntoPieces(mesh, 64, 0.4);  // 25.6 long
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].position, mesh.position);
}

TEST(WallPieces, EachFitsAndTogetherTheyAreTheSurface) {
  const SurfaceMesh mesh = tube();
  const auto pieces = cutIntoPieces(mesh, 16, 0.4);  // 6.4 long
  EXPECT_GE(pieces.size(), 4U);
  double area = 0;
  for (const SurfaceMesh& piece : pieces) {
    area += areaOf(piece);
    Eigen::AlignedBox3d box;
    for (std::uint32_t v = 0; v < piece.position.size(); ++v) box.extend(corner(piece, v));
    EXPECT_LE(box.sizes().maxCoeff(), 6.4 + 1e-6);
  }
  EXPECT_NEAR(area, areaOf(mesh), 1e-4 * area);
}

TEST(WallPieces, TrianglesOfPiecesLookOutwardsAsBefore) {
  for (const SurfaceMesh& piece : cutIntoPieces(tube(), 16, 0.4))
    for (const Triangle& t : piece.triangle) {
      Eigen::Vector3d outwards = corner(piece, t[0]) + corner(piece, t[1]) + corner(piece, t[2]);
      outwards.x() = 0;
      ASSERT_GT(areaOf(piece, t).dot(outwards), 0);
    }
}

TEST(WallPrisms, OneForEachTriangleAndTheLumenStaysOpen) {
  const SurfaceMesh mesh = tube();
  const auto prisms = wallPrisms(mesh, 0.5, 1e-6, isInTube);
  EXPECT_EQ(prisms.size(), mesh.triangle.size());
  // chords of 24 sides
  const double least = kRadius * std::cos(std::numbers::pi / kSides);
  for (const SurfaceMesh& prism : prisms)
    for (const Triangle& t : prism.triangle) {
      const Eigen::Vector3d middle =
          (corner(prism, t[0]) + corner(prism, t[1]) + corner(prism, t[2])) / 3;
      ASSERT_GE(std::hypot(middle.y(), middle.z()), least - 1e-6);
    }
}

TEST(WallPrisms, TheyAreLowerWhereAnotherLumenIsNear) {
  // a second lumen begins 0.2 above the first
  const auto inEither = [](const Float3& p) { return isInTube(p) || p[1] > kRadius + 0.2; };
  for (const SurfaceMesh& prism : wallPrisms(tube(), 0.5, 1e-6, inEither))
    for (const Float3& p : prism.position) ASSERT_LE(p[1], kRadius + 0.2 + 1e-6);
}

/// A square of 20 mm across the x axis at `x`, m, that looks along x (1) or against it (-1), in a box of 10 mm depth.
SurfaceMesh plate(double x, int side) {
  SurfaceMesh mesh;
  const auto at = static_cast<float>(x);
  for (const float depth : {0.0F, -0.010F})
    for (const auto& [y, z] :
         {std::pair{-0.01F, -0.01F}, {0.01F, -0.01F}, {0.01F, 0.01F}, {-0.01F, 0.01F}})
      mesh.position.push_back({at + depth, y, z});
  mesh.triangle = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}};  // the last one gives the box a depth
  if (side < 0)
    for (Triangle& t : mesh.triangle) std::swap(t[1], t[2]);
  return mesh;
}

const Eigen::Vector3d kTip(0, 0, 0), kForward = Eigen::Vector3d::UnitX();

}  // namespace

TEST(WireReach, IsFreeBehindItsTipWhereNothingIs) {
  EXPECT_EQ(freeBehind({}, kTip, kForward, 0.08, 1e-4), 0.08);
  EXPECT_EQ(freeBehind({plate(0.05, 1)}, kTip, kForward, 0.08, 1e-4), 0.08);
}

TEST(WireReach, EndsAtAWallBehindItsTip) {
  // the wall of another vessel crosses what is behind the tip, solid on its far side
  EXPECT_NEAR(freeBehind({plate(-0.03, 1)}, kTip, kForward, 0.08, 1e-4), 0.03, 3e-4);
}

TEST(WireReach, IsNotFreeInWhatIsSolid) {
  EXPECT_LT(freeBehind({plate(0.005, 1)}, kTip, kForward, 0.08, 1e-4), 1e-3);
}

}  // namespace lumen::convert
