// SPDX-License-Identifier: Apache-2.0
// The motion of phantoms, which is known exactly.
#include "converters/stages/motion/track_motion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "converters/base/error.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/stages/motion/posing.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::convert {
namespace {

constexpr double kVoxel = 0.5;

struct Moving {
  Phantom phantom;
  std::vector<Volume> phases;
  formats::Case rest;  // tracked
};

Moving makeMoving(const std::string& name, PhantomMotion motion) {
  PhantomOptions options;
  options.name = name;
  options.voxel = kVoxel;
  options.size = 104;
  options.motion = motion;
  options.phases = 4;
  Progress silent;
  Moving m;
  m.phases.resize(4);
  m.phantom = makePhantom(
      options,
      [&](int phase, const Volume& volume) { m.phases[static_cast<std::size_t>(phase)] = volume; },
      silent);
  m.phases[0] = m.phantom.volume;
  m.rest = trackFromSeeds(m.phases[0], m.phantom.seeds, TrackOptions{}, silent).result;
  return m;
}

TrackedMotion trackPhases(const Moving& m) {
  Progress silent;
  return trackMotion(
      m.rest, {0, 0.25, 0.5, 0.75}, 1, [&](std::size_t phase) { return m.phases[phase]; },
      MotionOptions{}, silent);
}

std::vector<formats::Pose> posesOf(const formats::Motion& motion, std::size_t phase) {
  const auto first = motion.pose.begin() + static_cast<std::ptrdiff_t>(phase * motion.node.size());
  return {first, first + static_cast<std::ptrdiff_t>(motion.node.size())};
}

// Distances of posed wall points from the true wall of a phase, in voxels, ascending.
std::vector<double> wallErrors(const Moving& m, const formats::Motion& motion, std::size_t phase) {
  const formats::CenterlineTree wall =
      posedTree(m.phantom.truth.tree, posesOf(*m.phantom.truth.motion, phase));
  const TubeTreeDistance truth(wall);
  std::vector<double> errors;
  const formats::Case posed = posedWalls(m.rest, posesOf(motion, phase));
  for (const formats::Vec3f& point : posed.points->position)
    errors.push_back(std::abs(truth.nearest(toEigen(point)).distance) / kVoxel);
  std::sort(errors.begin(), errors.end());
  return errors;
}

void expectFollowed(const std::string& name, PhantomMotion kind, double farthest) {
  const Moving m = makeMoving(name, kind);
  const TrackedMotion tracked = trackPhases(m);
  ASSERT_EQ(tracked.phases.size(), 4U);
  EXPECT_GT(tracked.phases[2].farthest, farthest);
  for (std::size_t phase = 0; phase < 4; ++phase) {
    const std::vector<double> errors = wallErrors(m, tracked.motion, phase);
    EXPECT_LT(errors[errors.size() / 2], 0.25) << name << ", phase " << phase;
    EXPECT_LT(errors[errors.size() * 9 / 10], 0.6) << name << ", phase " << phase;
    EXPECT_GT(tracked.phases[phase].seen, 0.9);
  }
}

TEST(TrackMotion, FollowsAnArteryOnABeatingHeart) {
  expectFollowed("coronary", PhantomMotion::Heart, 2);
}

TEST(TrackMotion, FollowsALiverThatBreathes) {
  expectFollowed("hepatic", PhantomMotion::Breath, 6);
}

TEST(TrackMotion, DoesNotDependOnThreads) {
  const Moving m = makeMoving("coronary", PhantomMotion::Heart);
  const TrackedMotion many = trackPhases(m);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(trackPhases(m).motion, many.motion);
}

TEST(TrackMotion, RefusesAPhaseThatShowsNothing) {
  Moving m = makeMoving("coronary", PhantomMotion::Heart);
  m.phases[2].voxels = std::vector<float>(m.phases[2].geometry.voxelCount(), 5.0F);
  EXPECT_THROW(trackPhases(m), Error);
}

TEST(MovingPhantom, StartsAtRestAndMovesByMillimetres) {
  const Moving m = makeMoving("coronary", PhantomMotion::Heart);
  const formats::Motion& motion = *m.phantom.truth.motion;
  EXPECT_EQ(motion.period, 0.8);
  ASSERT_EQ(motion.time.size(), 4U);
  for (std::size_t t = 0; t < 4; ++t)
    EXPECT_NEAR(motion.time[t], 0.2 * static_cast<double>(t), 1e-12);
  const std::size_t nodes = m.phantom.truth.tree.nodeCount();
  ASSERT_EQ(motion.pose.size(), 4 * nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    EXPECT_LT((toEigen(motion.pose[i].centre) - toEigen(m.phantom.truth.tree.centre[i])).norm(),
              1e-5);
    EXPECT_NEAR(motion.pose[i].rotation[3], 1, 1e-6);
  }
  // systole: the voxels on the axis of the moved artery are bright, those of the artery at rest are not all
  const auto brightness = [&](std::size_t phase, std::size_t node, std::size_t volume) {
    const VolumeGeometry& g = m.phases[volume].geometry;
    const Eigen::Vector3d at = g.indexFromWorld(toEigen(motion.pose[phase * nodes + node].centre));
    const auto& voxels = std::get<std::vector<std::int16_t>>(m.phases[volume].voxels);
    return voxels[g.index({static_cast<int>(std::lround(at.x())),
                           static_cast<int>(std::lround(at.y())),
                           static_cast<int>(std::lround(at.z()))})];
  };
  std::size_t stays = 0;
  for (std::size_t i = 0; i < nodes; i += 5) {
    EXPECT_GT(brightness(2, i, 2), 500) << i;
    stays += brightness(0, i, 2) > 500 ? 1 : 0;
  }
  EXPECT_LT(stays, nodes / 5 / 2);
}

TEST(MovingPhantom, RefusesAWallThatIsNotThatOfItsTree) {
  PhantomOptions options;
  options.name = "ellipse-tube";
  options.motion = PhantomMotion::Heart;
  Progress silent;
  EXPECT_THROW(makePhantom(options, silent), Error);
}

}  // namespace
}  // namespace lumen::convert
