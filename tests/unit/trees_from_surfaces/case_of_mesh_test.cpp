// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "formats/case/topology.h"
#include "tests/unit/trees_from_surfaces/tube_mesh.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

MeshCase made(const TriangleMesh& mesh, const std::optional<GivenCenterline>& line = {}) {
  Progress progress;
  return caseOfMesh(mesh, "tube.stl", line, {}, progress);
}

double lengthOf(const formats::CenterlineTree& tree) {
  double length = 0;
  for (const formats::Branch& branch : tree.branches) length += formats::branchLength(tree, branch);
  return length;
}

TEST(CaseOfMesh, FollowsATubeFromEndToEnd) {
  for (const bool hasCaps : {false, true}) {
    const formats::Case value = made(test::tube(test::straight(40), 2, hasCaps)).result;
    ASSERT_EQ(value.tree.branches.size(), 1U);
    const std::size_t n = value.tree.nodeCount();
    // the flat ends of the first and last cylinder are the tube's
    EXPECT_NEAR(lengthOf(value.tree) + 0.5 * (value.tree.height[0] + value.tree.height[n - 1]), 40,
                0.1);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(value.tree.radius[i], 2, 0.03);
      EXPECT_NEAR(std::hypot(value.tree.centre[i].y, value.tree.centre[i].z), 0, 0.02);
      EXPECT_GE(value.points->offset[i + 1] - value.points->offset[i], 40U);
    }
  }
}

TEST(CaseOfMesh, PutsPointsOnTheWall) {
  const formats::Case value = made(test::tube(test::straight(40), 2, false, 64)).result;
  for (const formats::Vec3f& p : value.points->position) {
    EXPECT_NEAR(std::hypot(p.y, p.z), 2, 0.005);
    EXPECT_GT(p.x, -1e-3);
    EXPECT_LT(p.x, 40.001);
  }
}

TEST(CaseOfMesh, KeepsTubesApartThatNearlyTouch) {
  // a wide and a narrow one, a fortieth of a voxel of the search apart
  TriangleMesh mesh = test::tube(test::straight(40), 3, true);
  test::append(mesh, test::tube(test::straight(40, 4.02), 1, true));
  const formats::Case value = made(mesh).result;
  ASSERT_EQ(value.tree.branches.size(), 2U);
  for (std::size_t i = 0; i < value.tree.nodeCount(); ++i)
    EXPECT_NEAR(value.tree.radius[i], value.tree.centre[i].y > 2 ? 1 : 3, 0.05);
}

/// A tube of radius 2 along x, open at both ends, with a hole of about 0.8 in its side at x = 20.
TriangleMesh tubeWithHole() {
  TriangleMesh mesh = test::tube(test::straight(40, 0, 200), 2, false, 64);
  std::erase_if(mesh.triangle, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return (mesh.position[v] - Vector3d(20, 2, 0)).norm() < 0.9;
    });
  });
  return mesh;
}

TEST(CaseOfMesh, AnOpeningIsAnEndHoweverShortItsVessel) {
  const MeshCase out = made(tubeWithHole());
  ASSERT_EQ(out.openings.size(), 3U);
  const formats::CenterlineTree& tree = out.result.tree;
  ASSERT_EQ(tree.branches.size(), 2U);
  const std::uint32_t last = tree.branches[1].firstNode + tree.branches[1].nodeCount - 1;
  EXPECT_GE(tree.branches[1].parentNode, 0);
  EXPECT_NEAR(tree.centre[last].x, 20, 0.5);
  EXPECT_GT(tree.centre[last].y, 0.5);
  for (const std::string& note : out.notes)
    EXPECT_EQ(note.find("no end of the tree"), std::string::npos) << note;
}

TEST(CaseOfMesh, ClosesALoopByALink) {
  const formats::Case value = made(test::ring(10, 2)).result;
  ASSERT_EQ(value.tree.links.size(), 1U);
  const auto [a, b] = value.tree.links[0];
  const Vector3d gap(value.tree.centre[a].x - value.tree.centre[b].x,
                     value.tree.centre[a].y - value.tree.centre[b].y,
                     value.tree.centre[a].z - value.tree.centre[b].z);
  EXPECT_LT(gap.norm(), 6);
}

/// A tube of radius 2 that goes along x, turns in a half circle, and comes down onto its own side as far as `gap` from it.
TriangleMesh hookOntoItself(double gap) {
  std::vector<Vector3d> axis = test::straight(30);
  for (int degrees = -87; degrees <= 180; degrees += 3) {
    const double angle = degrees * std::numbers::pi / 180;
    axis.emplace_back(30 + 9 * std::cos(angle), 9 + 9 * std::sin(angle), 0.0);
  }
  for (int i = 1; i <= 12; ++i) axis.emplace_back(21, 9 - (7 - gap) * i / 12, 0.0);
  return test::tube(axis, 2, true);
}

TEST(CaseOfMesh, ATipThatComesRoundBesideAVesselBehindAWallGetsNoLink) {
  for (const double gap : {0.1, 0.3}) {
    const formats::Case value = made(hookOntoItself(gap)).result;
    EXPECT_EQ(value.tree.branches.size(), 1U) << gap;
    EXPECT_TRUE(value.tree.links.empty()) << gap;
  }
}

GivenCenterline alongTube(double scale) {
  GivenCenterline given;
  given.name = "line.swc";
  for (int i = 0; i <= 36; ++i)
    given.file.points.push_back({Vector3d(scale * (2 + i), 0, 0), 2.0, i - 1});
  return given;
}

TEST(CaseOfMesh, AnOpeningThatAGivenCenterlineMissesIsReported) {
  const MeshCase out = made(tubeWithHole(), alongTube(1));
  EXPECT_EQ(std::count_if(out.notes.begin(), out.notes.end(),
                          [](const std::string& note) {
                            return note.find("no end of the tree") != std::string::npos;
                          }),
            1);
}

TEST(CaseOfMesh, FollowsAGivenCenterline) {
  const formats::Case value = made(test::tube(test::straight(40), 2, false), alongTube(1)).result;
  ASSERT_EQ(value.tree.branches.size(), 1U);
  EXPECT_NEAR(lengthOf(value.tree), 38, 1.2);
}

TEST(CaseOfMesh, SaysThatACenterlineIsInAnotherFrame) {
  try {
    made(test::tube(test::straight(40), 2, false), alongTube(-1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    const std::string what = error.what();
    EXPECT_NE(what.find("0 of its 37 points lie inside"), what.npos) << what;
    EXPECT_NE(what.find("with x and y negated, all would"), what.npos) << what;
    EXPECT_NE(what.find("centerline-frame ras"), what.npos) << what;
  }
}

/// A tube of radius 2.6 within one of radius 3, facing one another's backs; joined at the ends or not.
TriangleMesh wallOfATube(bool isJoined) {
  TriangleMesh wall = test::tube(test::straight(40), 3, !isJoined);
  TriangleMesh inner = test::tube(test::straight(38), 2.6, !isJoined);
  if (isJoined) inner = test::tube(test::straight(40), 2.6, false);
  if (isJoined)
    for (Triangle& t : inner.triangle) std::swap(t[0], t[1]);
  for (Eigen::Vector3d& p : inner.position)
    if (!isJoined) p.x() += 1;
  const auto first = static_cast<std::uint32_t>(wall.position.size());
  test::append(wall, inner);
  if (!isJoined) return wall;
  for (std::uint32_t k = 0; k < 32; ++k) {
    const std::uint32_t n = (k + 1) % 32, far = 60 * 32;
    wall.triangle.push_back({n, k, first + k});
    wall.triangle.push_back({n, first + k, first + n});
    wall.triangle.push_back({far + k, far + n, first + far + n});
    wall.triangle.push_back({far + k, first + far + n, first + far + k});
  }
  return wall;
}

TEST(CaseOfMesh, OfAWallWithAThicknessTheInnerSideIsTaken) {
  for (const bool isJoined : {true, false}) {
    const MeshCase wall = made(wallOfATube(isJoined));
    ASSERT_EQ(wall.notes.size(), 1U) << isJoined;
    EXPECT_NE(wall.notes[0].find("inner side"), std::string::npos) << wall.notes[0];
    EXPECT_EQ(wall.result.tree.branches.size(), 1U);
    for (const float radius : wall.result.tree.radius) EXPECT_NEAR(radius, 2.6, 0.03);
  }
}

TEST(CaseOfMesh, WhatLiesWithinALumenIsLeftOut) {
  TriangleMesh mesh = test::tube(test::straight(40), 3, true);
  TriangleMesh stone = test::tube(test::straight(2), 0.5, true);
  for (Eigen::Vector3d& p : stone.position) p.x() += 20;
  test::append(mesh, stone);
  const MeshCase tube = made(mesh);
  EXPECT_EQ(tube.notes,
            std::vector<std::string>{"tube.stl: 1 part that lies within another one was left out"});
  for (const float radius : tube.result.tree.radius) EXPECT_NEAR(radius, 3, 0.03);
}

TEST(CaseOfMesh, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = test::ring(10, 2);
  const formats::Case many = made(mesh).result;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(made(mesh).result, many);
}

}  // namespace
}  // namespace lumen::convert
