// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/track_case.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/vectors.h"
#include "tube_volume.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;
using formats::StopReason;

TEST(Tracker, FollowsAStraightTubeToBothEndsFromOneClickInItsMiddle) {
  const TrackResult out = trackOne(straightTube(1.0), {seedAt("tube", {6.2, 6.5, 6.0})});
  ASSERT_TRUE(out.failures.empty());
  const auto& tree = out.result.tree;
  EXPECT_LT(tree.centre.front().z, 1.5F);
  EXPECT_GT(tree.centre.back().z, 11.0F);
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    EXPECT_NEAR(tree.centre[i].x, 6.4, 0.04);
    EXPECT_NEAR(tree.centre[i].y, 6.4, 0.04);
    EXPECT_NEAR(tree.radius[i], 1.0, 0.04);
    EXPECT_GT(tree.direction[i].z, 0.99F);
    EXPECT_EQ(tree.parent[i], static_cast<int>(i) - 1);
  }
}

TEST(Tracker, NodesHoldWallPointsWithinTheirHeight) {
  const TrackResult out = trackOne(straightTube(1.0), {seedAt("tube", {6.4, 6.4, 6.0}, 1.0)});
  const auto& tree = out.result.tree;
  const auto& points = *out.result.points;
  ASSERT_EQ(points.offset.size(), tree.nodeCount() + 1);
  for (std::size_t i = 0; i < tree.nodeCount(); ++i) {
    EXPECT_GT(points.offset[i + 1] - points.offset[i], 40u);
    for (std::uint32_t k = points.offset[i]; k < points.offset[i + 1]; ++k) {
      const Vector3d p = toEigen(points.position[k]) - toEigen(tree.centre[i]);
      EXPECT_LE(std::abs(p.dot(toEigen(tree.direction[i]))), 0.5 * tree.height[i] + 1e-3);
      EXPECT_NEAR(p.cross(toEigen(tree.direction[i])).norm(), tree.radius[i],
                  0.11 * tree.radius[i]);
    }
  }
}

TEST(Tracker, WithADirectionGoesOneWayOnly) {
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 6.0}, 1.0);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(straightTube(1.0), {seed});
  EXPECT_GT(out.result.tree.centre.front().z, 5.0F);
  EXPECT_GT(out.result.tree.centre.back().z, 11.0F);
}

TEST(Tracker, AStraightTubeThatLeavesTheVolumeSaysSo) {
  const Volume volume = drawVolume(48, 0.2, [](const Vector3d& p) {
    return capsule(p, {4.8, 4.8, -5}, {4.8, 4.8, 15}, 0.8);
  });
  SeedBranch seed = seedAt("tube", {4.8, 4.8, 4}, 0.8);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(volume, {seed});
  ASSERT_EQ(out.result.tree.branches.size(), 1u);
  EXPECT_EQ(out.result.tree.branches[0].stopReason, StopReason::LeftVolume);
}

TEST(Tracker, AChildHangsOnTheNodeOfItsParentNearestToItsClick) {
  SeedBranch trunk = seedAt("trunk", {6.4, 6.4, 1.5}, 1.2);
  trunk.direction = Vector3d::UnitZ();
  SeedBranch child = seedAt("child", {8.6, 6.5, 6.4}, 0.7);
  child.parent = "trunk";
  const TrackResult out = trackOne(tee(0.7), {trunk, child});
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  const auto& branch = out.result.tree.branches[1];
  const auto& parent = out.result.tree.centre[static_cast<std::size_t>(branch.parentNode)];
  EXPECT_NEAR(parent.z, 6.4, 0.8);
  EXPECT_GT(out.result.tree.centre.back().x, 11.0F);
  EXPECT_NEAR(out.result.tree.radius[branch.firstNode + 3], 0.7, 0.05);
}

TEST(Tracker, ANarrowChildStartsFromOneClickWithoutARadius) {
  SeedBranch trunk = seedAt("trunk", {6.4, 6.4, 1.5}, 1.2);
  trunk.direction = Vector3d::UnitZ();
  SeedBranch child = seedAt("child", {8.6, 6.5, 6.4});
  child.parent = "trunk";
  const TrackResult out = trackOne(tee(0.4), {trunk, child});
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  EXPECT_GT(out.result.tree.centre.back().x, 11.0F);
  EXPECT_NEAR(out.result.tree.radius.back(), 0.4, 0.05);
}

/// A tube along z that is missing between two heights.
Volume interruptedTube(double from, double to) {
  return drawVolume(64, 0.2, [=](const Vector3d& p) {
    return std::min(capsule(p, kLow, {6.4, 6.4, from - 1.0}, 1.0),
                    capsule(p, {6.4, 6.4, to + 1.0}, kHigh, 1.0));
  });
}

double reachedFromBelow(const Volume& volume, int lookAhead) {
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 2.5}, 1.0);
  seed.direction = Vector3d::UnitZ();
  Progress silent;
  TrackOptions options;
  options.lookAhead = lookAhead;
  return trackFromSeeds(volume, {seed}, options, silent).result.tree.centre.back().z;
}

TEST(Tracker, LooksBeyondAShortGap) {
  const Volume volume = interruptedTube(6.0, 7.2);
  EXPECT_GT(reachedFromBelow(volume, 4), 11.0);
  EXPECT_LT(reachedFromBelow(volume, 0), 7.0);
}

/// A trunk along z that forks at half its height: a straight arm, and one that turns off along x.
Volume fork() {
  return drawVolume(64, 0.2, [](const Vector3d& p) {
    return std::min(capsule(p, kLow, kHigh, 0.8),
                    capsule(p, {6.4, 6.4, 6.4}, {12.0, 6.4, 6.4}, 0.8));
  });
}

TEST(Tracker, PassesThroughAFurtherClickInsteadOfGoingStraightOn) {
  SeedBranch seed = seedAt("vessel", {6.4, 6.4, 1.5}, 0.8);
  seed.direction = Vector3d::UnitZ();
  seed.points.push_back({{10.0, 6.4, 6.4}, 0.8});
  const TrackResult out = trackOne(fork(), {seed});
  EXPECT_TRUE(out.missedPoints.empty());
  const auto& tree = out.result.tree;
  EXPECT_GT(tree.centre.back().x, 11.0F);
  for (std::size_t i = 1; i < tree.nodeCount(); ++i)
    EXPECT_LT((toEigen(tree.centre[i]) - toEigen(tree.centre[i - 1])).norm(), 1.7);
}

TEST(Tracker, ReportsAFurtherClickWhereNothingFits) {
  SeedBranch seed = seedAt("vessel", {6.4, 6.4, 1.5}, 0.8);
  seed.direction = Vector3d::UnitZ();
  seed.points.push_back({{2.0, 2.0, 6.4}, 0.8});
  const TrackResult out = trackOne(fork(), {seed});
  ASSERT_EQ(out.missedPoints.size(), 1u);
  EXPECT_EQ(out.missedPoints[0].reason.rfind("point 2", 0), 0u);
}

TEST(Tracker, ADistantClickOnAChildIsTrackedBackToItsParent) {
  SeedBranch trunk = seedAt("trunk", {6.4, 6.4, 1.5}, 1.2);
  trunk.direction = Vector3d::UnitZ();
  SeedBranch child = seedAt("child", {11.0, 6.4, 6.4}, 0.7);
  child.parent = "trunk";
  const TrackResult out = trackOne(tee(0.7), {trunk, child});
  ASSERT_EQ(out.result.tree.branches.size(), 2u);
  EXPECT_LT(out.result.tree.centre[out.result.tree.branches[1].firstNode].x, 8.5F);
}

TEST(Tracker, StopsAtARealEndInNoise) {
  const Volume volume = noisy(drawVolume(64, 0.2,
                                         [](const Vector3d& p) {
                                           return capsule(p, kLow, {6.4, 6.4, 7.0}, 0.3);
                                         }),
                              50);
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 2.5}, 0.3);
  seed.direction = Vector3d::UnitZ();
  const TrackResult out = trackOne(volume, {seed});
  EXPECT_NEAR(out.result.tree.centre.back().z, 7.0, 1.0);
}

TEST(Tracker, NoiseAloneStartsNoTrack) {
  const Volume volume = noisy(drawVolume(64, 0.2, [](const Vector3d&) { return 9.0; }), 50);
  std::vector<SeedBranch> seeds;
  for (int i = 0; i < 20; ++i)
    seeds.push_back(seedAt(std::to_string(i), Vector3d(2.0 + 0.4 * i, 6.4, 3.0 + 0.3 * i)));
  EXPECT_EQ(trackOne(volume, seeds).failures.size(), seeds.size());
}

TEST(Tracker, DoesNotJumpFromItsEndToAVesselThatPassesBeyond) {
  const Vector3d across = Vector3d(1, 0, 0.9).normalized();
  const Vector3d beyond(6.4, 6.4, 8.0);
  const Volume volume = drawVolume(64, 0.2, [&](const Vector3d& p) {
    return std::min(capsule(p, kLow, {6.4, 6.4, 6.0}, 0.4),
                    capsule(p, beyond - 4.0 * across, beyond + 4.0 * across, 0.4));
  });
  SeedBranch seed = seedAt("tube", {6.4, 6.4, 2.5}, 0.4);
  seed.direction = Vector3d::UnitZ();
  EXPECT_LT(trackOne(volume, {seed}).result.tree.centre.back().z, 6.6F);
}

TEST(Tracker, TheCentresOfAWideBentVesselLieOnItsAxis) {
  // a ring of radius 4.5 mm of a tube of radius 1.4 mm; half of it lies in the volume
  const Vector3d middle(6.4, 6.4, 0.0);
  const Volume volume = drawVolume(64, 0.2, [&](const Vector3d& p) {
    const Vector3d q = p - middle;
    return std::hypot(std::hypot(q.x(), q.z()) - 4.5, q.y()) - 1.4;
  });
  const auto& tree = trackOne(volume, {seedAt("arch", {6.4, 6.4, 4.5}, 1.4)}).result.tree;
  ASSERT_GT(tree.nodeCount(), 6u);
  double sum = 0;
  for (std::size_t n = 2; n + 2 < tree.nodeCount(); ++n) {
    const Vector3d q = toEigen(tree.centre[n]) - middle;
    sum += std::hypot(q.x(), q.z()) / static_cast<double>(tree.nodeCount() - 4);
  }
  EXPECT_NEAR(sum, 4.5, 0.02);
}

TEST(Tracker, ASecondClickOnTheSameVesselIsRefused) {
  const TrackResult out = trackOne(straightTube(1.0), {seedAt("first", {6.4, 6.4, 6}, 1.0),
                                                       seedAt("again", {6.4, 6.4, 8}, 1.0)});
  ASSERT_EQ(out.failures.size(), 1u);
  EXPECT_EQ(out.failures[0].label, "again");
  EXPECT_NE(out.failures[0].reason.find("another seed"), std::string::npos);
  EXPECT_EQ(out.result.tree.branches.size(), 1u);
}

/// The number after `words` in `text`.
double numberAfter(const std::string& text, const std::string& words) {
  const auto at = text.find(words);
  EXPECT_NE(at, std::string::npos) << words << " is not in: " << text;
  return at == std::string::npos ? NAN : std::stod(text.substr(at + words.size()));
}

/// A reason that gives a rate and the least one must be about a rate that is too low, and likewise
/// for rays and for walls.
void expectReasonHolds(const std::string& reason) {
  const auto has = [&](const char* words) { return reason.find(words) != std::string::npos; };
  if (has("best inlier rate")) {
    EXPECT_LT(numberAfter(reason, "best inlier rate "), numberAfter(reason, "at least ")) << reason;
  }
  if (has("rays meet")) {
    EXPECT_LT(numberAfter(reason, "at most "), numberAfter(reason, "at least ")) << reason;
  }
  if (has("as strong as noise")) {
    EXPECT_LT(numberAfter(reason, "its wall is "), numberAfter(reason, "at least ")) << reason;
  }
}

TEST(Tracker, AClickInTheBackgroundFailsWithTheRaysThatMeetAWall) {
  const TrackResult out = trackOne(straightTube(0.6), {seedAt("nothing", {2, 2, 2}, 0.6)});
  ASSERT_EQ(out.failures.size(), 1u);
  EXPECT_NE(out.failures[0].reason.find("0 rays meet"), std::string::npos);
}

TEST(Tracker, NoReasonContradictsItself) {
  // clicks of every kind of failure: in noise, beside a vessel, at a face, with a wrong radius
  std::set<std::string> kinds;
  for (const double noise : {0.0, 50.0, 400.0}) {
    const Volume volume = noisy(straightTube(0.6), noise);
    std::vector<SeedBranch> seeds;
    for (int i = 0; i < 60; ++i)
      seeds.push_back(seedAt(std::to_string(i),
                             Vector3d(0.2 * i + 0.3, 6.4 - 0.1 * (i % 12), 0.21 * (60 - i)),
                             0.1 + 0.1 * (i % 20)));
    for (const SeedFailure& failure : trackOne(volume, seeds).failures) {
      expectReasonHolds(failure.reason);
      kinds.insert(failure.reason.substr(0, 32));
    }
  }
  EXPECT_GE(kinds.size(), 4U);
}

TEST(Tracker, AFitThatIsNoBetterThanNoiseSaysSo) {
  const Volume volume = noisy(drawVolume(64, 0.2, [](const Vector3d&) { return 9.0; }), 50);
  std::vector<SeedBranch> seeds;
  for (int i = 0; i < 20; ++i)
    seeds.push_back(seedAt(std::to_string(i), Vector3d(2.0 + 0.4 * i, 6.4, 3.0 + 0.3 * i)));
  const TrackResult out = trackOne(volume, seeds);
  EXPECT_TRUE(std::any_of(out.failures.begin(), out.failures.end(), [](const SeedFailure& failure) {
    return failure.reason.find("noise-margin") != std::string::npos;
  }));
}

/// The warnings of a track.
class Warnings : public Progress {
public:
  void warn(std::string_view message) override { text.append(message).append("\n"); }
  std::string text;
};

TEST(Tracker, SeedsOnVesselsOfTheOtherSignAreWarnedOf) {
  const Volume bright = straightTube(0.6);
  Volume dark = bright;
  for (auto& v : std::get<std::vector<std::int16_t>>(dark.voxels))
    v = static_cast<std::int16_t>(1000 - v);
  const std::vector<SeedBranch> seeds{seedAt("tube", {6.4, 6.4, 6.0}, 0.6)};
  TrackOptions forDark;
  forDark.dark = true;
  const auto warned = [&](const Volume& volume, const TrackOptions& options) {
    Warnings warnings;
    (void)trackFromSeeds(volume, seeds, options, warnings);
    return warnings.text;
  };
  EXPECT_EQ(warned(bright, {}), "");
  EXPECT_EQ(warned(dark, forDark), "");
  EXPECT_NE(warned(dark, {}).find("add dark"), std::string::npos);
  EXPECT_NE(warned(bright, forDark).find("leave it out"), std::string::npos);
}

TEST(Tracker, VoxelsThatAreTooUnevenAreRefusedAtOnce) {
  Volume volume = straightTube(0.6);
  volume.geometry.spacing = {0.001, 0.001, 5};
  EXPECT_THROW(trackOne(volume, {seedAt("tube", {0.03, 0.03, 100})}), Error);
}

TEST(Tracker, TouchingTubesStayApart) {
  const auto left = [](const Vector3d& p) {
    return capsule(p, {5.4, 6.4, 0.4}, {5.4, 6.4, 12.2}, 1.0);
  };
  const auto right = [](const Vector3d& p) {
    return capsule(p, {7.4, 6.4, 0.4}, {7.4, 6.4, 12.2}, 1.0);
  };
  const Volume volume =
      drawVolume(64, 0.2, [&](const Vector3d& p) { return std::min(left(p), right(p)); });
  const TrackResult out =
      trackOne(volume, {seedAt("left", {5.3, 6.4, 6}, 1.0), seedAt("right", {7.5, 6.4, 6}, 1.0)});
  ASSERT_TRUE(out.failures.empty());
  for (std::size_t i = 0; i < out.result.tree.nodeCount(); ++i)
    EXPECT_NEAR(out.result.tree.centre[i].x, out.result.tree.branch[i] == 0 ? 5.4 : 7.4, 0.1);
}

TEST(Tracker, AnAneurysmKeepsTheWallPointsSeenFromItsCentres) {
  const Vector3d centre(6.4, 6.4, 6.4);
  const Volume volume =
      drawVolume(64, 0.2, [&](const Vector3d& p) { return (p - centre).norm() - 3.0; });
  SeedBranch sac = seedAt("sac", {6.0, 6.4, 6.4}, 2.6);
  sac.points.push_back({{7.0, 6.4, 6.4}, 2.6});
  sac.kind = BranchKind::Aneurysm;
  const TrackResult out = trackOne(volume, {sac});
  const auto& tree = out.result.tree;
  ASSERT_EQ(tree.nodeCount(), 2u);
  EXPECT_EQ(tree.branches[0].kind, BranchKind::Aneurysm);
  EXPECT_NEAR(tree.direction[1].x, 1.0, 1e-6);
  EXPECT_NEAR(tree.height[0], 1.0, 1e-6);
  EXPECT_GT(out.result.points->position.size(), 300u);
  for (const auto& p : out.result.points->position)
    EXPECT_NEAR((toEigen(p) - centre).norm(), 3.0, 0.06);
}

TEST(Tracker, GivesTheSameCaseOnOneThreadAndOnTwo) {
  SeedBranch trunk = seedAt("trunk", {6.4, 6.4, 1.5}, 1.2);
  trunk.direction = Vector3d::UnitZ();
  SeedBranch child = seedAt("child", {8.6, 6.5, 6.4}, 0.7);
  child.parent = "trunk";
  const Volume volume = tee(0.7);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return trackOne(volume, {trunk, child}).result;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(Tracker, RefusesOptionsOutOfRangeByName) {
  Progress silent;
  TrackOptions options;
  options.rays = 100;
  try {
    trackFromSeeds(straightTube(1.0), {seedAt("tube", {6.4, 6.4, 6})}, options, silent);
    FAIL() << "accepted 100 rays";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("rays"), std::string::npos);
  }
}

TEST(Tracker, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(trackFromSeeds(straightTube(1.0), {seedAt("tube", {6.4, 6.4, 6}, 1.0)},
                              TrackOptions{}, progress),
               Error);
}

}  // namespace
}  // namespace lumen::convert
