// SPDX-License-Identifier: Apache-2.0
// A surface in pieces for MuJoCo's distance fields, and as prisms for CathSim.
#include "converters/export/targets/mujoco/wall_pieces.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "converters/export/targets/cathsim/wall_prisms.h"

namespace lumen::convert {

namespace {

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

}  // namespace

}  // namespace lumen::convert
