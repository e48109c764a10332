// SPDX-License-Identifier: Apache-2.0
// Aneurysms: the wall of the whole sac, and no wall between sac and vessel.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/vectors.h"
#include "converters/stages/fitting/fit.h"
#include "formats/case/case_field.h"
#include "formats/case/reachability.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;

constexpr double kVoxel = 0.2;

double ball(const Vector3d& p, const Vector3d& centre, double radius) {
  return (p - centre).norm() - radius;
}

/// A sac whose two lobes bulge behind corners, on the side of a vessel; beside it, with two voxels
/// of darkness in between, a vessel that nobody clicked.
struct LobedSac {
  static constexpr double kRadius = 2.2, kSide = 2.4;
  Vector3d centre{6.8, 6.4, 6.4};

  [[nodiscard]] static double vessel(const Vector3d& p) {
    return capsule(p, {kSide, 6.4, 0.4}, {kSide, 6.4, 12.2}, 1.0);
  }
  [[nodiscard]] double sac(const Vector3d& p) const {
    const double neck = capsule(p, {kSide, 6.4, 6.4}, centre, 0.9);
    const double body = ball(p, centre, kRadius);
    const double lobes = std::min(ball(p, centre + Vector3d(0.4, 2.8, 0.6), 1.1),
                                  ball(p, centre + Vector3d(-0.5, -1.2, 2.5), 1.0));
    return std::min({neck, body, lobes});
  }
  [[nodiscard]] double wall(const Vector3d& p) const { return std::min(vessel(p), sac(p)); }
  [[nodiscard]] Volume volume() const {
    return drawVolume(64, kVoxel, [&](const Vector3d& p) {
      return std::min(wall(p), capsule(p, {10.3, 4.4, 0.4}, {10.3, 6.4, 12.2}, 0.8));
    });
  }
  [[nodiscard]] std::vector<SeedBranch> seeds() const {
    SeedBranch root = seedAt("root", {kSide, 6.4, 1.5}, 1.0);
    root.direction = Vector3d::UnitZ();
    SeedBranch aneurysm = seedAt("sac", centre - Vector3d(0.6, 0, 0), 1.8);
    aneurysm.points.push_back({centre + Vector3d(0.4, 0, 0), 2.0});
    aneurysm.kind = BranchKind::Aneurysm;
    aneurysm.parent = "root";
    return {root, aneurysm};
  }
};

double gapAt(const formats::Case& value, const Vector3d& place) {
  double least = std::numeric_limits<double>::infinity();
  for (const formats::Vec3f& p : value.points->position)
    least = std::min(least, (toEigen(p) - place).norm());
  return least;
}

TEST(Aneurysm, EveryPartOfALobedSacHasAWallPointNearBy) {
  const LobedSac sac;
  const TrackResult out = trackOne(sac.volume(), sac.seeds());
  ASSERT_TRUE(out.failures.empty());
  double widest = 0;
  int places = 0;
  for (double x = 3.8; x < 11; x += kVoxel)
    for (double y = 1.4; y < 11.4; y += kVoxel)
      for (double z = 1.4; z < 11.4; z += kVoxel) {
        const Vector3d p(x, y, z);
        if (std::abs(sac.wall(p)) > 0.5 * kVoxel) continue;
        ++places;
        widest = std::max(widest, gapAt(out.result, p));
      }
  EXPECT_GT(places, 1000);
  EXPECT_LT(widest, 2.5 * kVoxel);
}

TEST(Aneurysm, IsTheSameWhereVesselsAreDark) {
  const LobedSac sac;
  Volume volume = sac.volume();
  const TrackResult bright = trackOne(volume, sac.seeds());
  for (std::int16_t& voxel : std::get<std::vector<std::int16_t>>(volume.voxels))
    voxel = static_cast<std::int16_t>(1000 - voxel);
  TrackOptions options;
  options.dark = true;
  Progress silent;
  const TrackResult dark = trackFromSeeds(volume, sac.seeds(), options, silent);
  // the centres of a lobe follow from depths, of which the last bits differ
  EXPECT_NEAR(static_cast<double>(dark.result.tree.nodeCount()),
              static_cast<double>(bright.result.tree.nodeCount()), 1);
  for (const formats::Vec3f& p : dark.result.points->position)
    EXPECT_LT(std::abs(sac.wall(toEigen(p))), 1.25 * kVoxel) << toEigen(p).transpose();
}

TEST(Aneurysm, WallPointsLieInNoLumenAndOnNoOtherVessel) {
  const LobedSac sac;
  const TrackResult out = trackOne(sac.volume(), sac.seeds());
  ASSERT_TRUE(out.failures.empty());
  for (const formats::Vec3f& p : out.result.points->position)
    EXPECT_LT(std::abs(sac.wall(toEigen(p))), 1.25 * kVoxel) << toEigen(p).transpose();
}

using Wall = std::function<double(const Vector3d&)>;

/// Pushes a point from a node to a place; the least of f - T, mm, where the truth is a voxel inside.
double leastOnPath(const formats::Case& value, const field::BlendedField& field, std::uint32_t node,
                   const Vector3d& to, const Wall& wall) {
  constexpr int kSteps = 64;
  const Vector3d from = toEigen(value.tree.centre[node]);
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t cursor = node;
  for (int i = 0; i <= kSteps; ++i) {
    const Vector3d p = from + (to - from) * (static_cast<double>(i) / kSteps);
    const field::Vec at{p.x(), p.y(), p.z()};
    cursor = field.follow(at, cursor);
    if (wall(p) < -kVoxel) least = std::min(least, field.blended(at, cursor).value - field.level());
  }
  return least;
}

/// From every node of the sac to the axis of the vessel that runs along z at x = `side`.
void expectNoWallBetween(const formats::Case& value, double side, const Wall& wall) {
  const field::BlendedField field = formats::caseField(value);
  int paths = 0;
  for (std::uint32_t n = 0; n < value.tree.nodeCount(); ++n) {
    if (value.tree.branches[value.tree.branch[n]].kind != BranchKind::Aneurysm) continue;
    for (const double z : {5.9, 6.4, 6.9})
      EXPECT_GT(leastOnPath(value, field, n, {side, 6.4, z}, wall), 0) << "from node " << n;
    ++paths;
  }
  EXPECT_GT(paths, 0);
  const auto reach = formats::measureReachability(value.tree, field);
  EXPECT_EQ(reach.reachable, reach.total);
}

TEST(Aneurysm, NoWallStandsInTheNeck) {
  const LobedSac sac;
  formats::Case value = trackOne(sac.volume(), sac.seeds()).result;
  Progress silent;
  fit(value, {}, silent);
  expectNoWallBetween(value, LobedSac::kSide, [&](const Vector3d& p) { return sac.wall(p); });
}

/// The vessel runs through the side of the sac, so that a half of its wall is missing there.
struct WideSac {
  static constexpr double kSide = 4.8;
  [[nodiscard]] static double wall(const Vector3d& p) {
    return std::min(capsule(p, {kSide, 6.4, 0.4}, {kSide, 6.4, 12.2}, 1.0),
                    ball(p, {6.6, 6.4, 6.4}, 2.6));
  }
  [[nodiscard]] static std::vector<SeedBranch> seeds() {
    SeedBranch root = seedAt("root", {kSide, 6.4, 1.5}, 1.0);
    root.direction = Vector3d::UnitZ();
    SeedBranch aneurysm = seedAt("sac", {7.0, 6.4, 6.4}, 2.3);
    aneurysm.kind = BranchKind::Aneurysm;
    aneurysm.parent = "root";
    return {root, aneurysm};
  }
};

TEST(Aneurysm, AVesselThroughItsSideHasNoWallWithin) {
  const TrackResult out = trackOne(drawVolume(64, kVoxel, WideSac::wall), WideSac::seeds());
  ASSERT_TRUE(out.failures.empty());
  for (const formats::Vec3f& p : out.result.points->position)
    EXPECT_GT(WideSac::wall(toEigen(p)), -1.25 * kVoxel) << toEigen(p).transpose();
  formats::Case value = out.result;
  Progress silent;
  fit(value, {}, silent);
  expectNoWallBetween(value, WideSac::kSide, WideSac::wall);
}

TEST(Aneurysm, NoWallStandsAtTheEndsOfALongNeck) {
  static constexpr double kSide = 1.9;
  const Wall wall = [](const Vector3d& p) {
    return std::min(capsule(p, {kSide, 6.4, 0.4}, {kSide, 6.4, 12.2}, 0.7),
                    ball(p, {6.7, 6.4, 6.4}, 4.6));
  };
  SeedBranch root = seedAt("root", {kSide, 6.4, 1.5}, 0.7);
  root.direction = Vector3d::UnitZ();
  SeedBranch sac = seedAt("sac", {6.7, 6.4, 6.4}, 4.4);
  sac.kind = BranchKind::Aneurysm;
  sac.parent = "root";
  formats::Case value = trackOne(drawVolume(64, kVoxel, wall), {root, sac}).result;
  Progress silent;
  fit(value, {}, silent);
  const field::BlendedField field = formats::caseField(value);
  for (double z = 4.8; z < 8.1; z += 0.2)
    for (double y = 6; y < 6.9; y += 0.2)
      EXPECT_GT(leastOnPath(value, field, static_cast<std::uint32_t>(value.tree.nodeCount() - 1),
                            {kSide, y, z}, wall),
                0)
          << "to " << y << " " << z;
}

TEST(Aneurysm, ALobeFarFromAllClicksGetsACentre) {
  const Vector3d body(4.4, 6.4, 6.4), lobe(7.8, 6.4, 6.4);
  const Volume volume = drawVolume(64, kVoxel, [&](const Vector3d& p) {
    return std::min(ball(p, body, 2.2), ball(p, lobe, 1.6));
  });
  SeedBranch sac = seedAt("sac", body, 2.2);
  sac.kind = BranchKind::Aneurysm;
  const TrackResult out = trackOne(volume, {sac});
  const formats::CenterlineTree& tree = out.result.tree;
  ASSERT_GE(tree.nodeCount(), 2u);
  EXPECT_LT((toEigen(tree.centre[0]) - body).norm(), 1e-3 * kVoxel);
  const std::uint32_t last = static_cast<std::uint32_t>(tree.nodeCount() - 1);
  EXPECT_LT((toEigen(tree.centre[last]) - lobe).norm(), 0.8);
  EXPECT_LT(gapAt(out.result, {9.4, 6.4, 6.4}), 2.5 * kVoxel);
}

TEST(Aneurysm, ItsChainLeadsAwayFromItsParentWhateverTheOrderOfItsClicks) {
  const LobedSac sac;
  std::vector<SeedBranch> seeds = sac.seeds();
  std::reverse(seeds[1].points.begin(), seeds[1].points.end());
  EXPECT_EQ(trackOne(sac.volume(), seeds).result.tree.centre,
            trackOne(sac.volume(), sac.seeds()).result.tree.centre);
}

}  // namespace
}  // namespace lumen::convert
