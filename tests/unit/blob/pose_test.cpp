// SPDX-License-Identifier: Apache-2.0
// Models that move: what a pose answers against the model at rest and against shapes that are known.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "allocations.h"
#include "blob_pose.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

struct PoseCloser {
  void operator()(blob_pose* pose) const { blob_pose_close(pose); }
};
using Pose = std::unique_ptr<blob_pose, PoseCloser>;

Pose makePose(const Model& rest, bool renews = false) {
  blob_pose_def def = blob_pose_def_default();
  def.renew = renews;
  blob_pose* pose = nullptr;
  EXPECT_EQ(blob_pose_create(rest.get(), &def, &pose), BLOB_OK);
  return Pose(pose);
}

// A motion of all space: X goes to offset + factor R (X - pivot).
struct Motion {
  blob_transform transform;
  Point pivot;

  [[nodiscard]] Point turn(const Point& v) const {
    const double* q = transform.rotation;
    const Point u{q[0], q[1], q[2]};
    const auto cross = [](const Point& a, const Point& b) {
      return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    Point t = cross(u, v);
    for (double& x : t) x *= 2;
    const Point twice = cross(u, t);
    return {v[0] + q[3] * t[0] + twice[0], v[1] + q[3] * t[1] + twice[1],
            v[2] + q[3] * t[2] + twice[2]};
  }
  [[nodiscard]] Point move(const Point& x) const {
    const Point turned = turn({x[0] - pivot[0], x[1] - pivot[1], x[2] - pivot[2]});
    Point result{};
    for (std::size_t i = 0; i < 3; ++i)
      result[i] = transform.centre[i] + transform.factor * turned[i];
    return result;
  }
  // The transform of a node under this motion.
  [[nodiscard]] blob_transform at(const blob_node& node) const {
    blob_transform result = transform;
    const Point moved = move({node.centre[0], node.centre[1], node.centre[2]});
    std::copy(moved.begin(), moved.end(), result.centre);
    return result;
  }
};

Motion someMotion(double factor = 1) {
  const double half = 0.6, s = std::sin(half) / std::sqrt(14.0);
  return {{{7, -3, 2}, {1 * s, -2 * s, 3 * s, std::cos(half)}, factor}, {1, 2, 0.5}};
}

std::size_t countNodes(const blob_model* model) {
  return blob_model_describe(model).node_count;
}

std::vector<blob_transform> transformsOf(const Model& rest, const Motion& motion) {
  std::vector<blob_transform> result;
  for (std::uint32_t i = 0; i < countNodes(rest.get()); ++i)
    result.push_back(motion.at(blob_model_node(rest.get(), i)));
  return result;
}

// Bends a model that lies along x into a circle of `radius` about the y axis' direction, which keeps the
// lengths of the axis.
std::vector<blob_transform> bendInto(const Model& rest, double radius) {
  std::vector<blob_transform> result;
  for (std::uint32_t i = 0; i < countNodes(rest.get()); ++i) {
    const blob_node node = blob_model_node(rest.get(), i);
    const double angle = node.centre[0] / radius, across = node.centre[1];
    blob_transform t{};
    t.centre[0] = (radius - across) * std::sin(angle);
    t.centre[1] = radius - (radius - across) * std::cos(angle);
    t.centre[2] = node.centre[2];
    t.rotation[2] = std::sin(0.5 * angle);
    t.rotation[3] = std::cos(0.5 * angle);
    t.factor = 1;
    result.push_back(t);
  }
  return result;
}

void set(const Pose& pose, const std::vector<blob_transform>& transforms,
         blob_pose_change* change = nullptr) {
  ASSERT_EQ(blob_pose_set(pose.get(), transforms.size(), nullptr, transforms.data(), change),
            BLOB_OK);
}

std::vector<Point> pointsAround(const blob_model* model, int perNode) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1.4, 1.4);
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < countNodes(model); ++i)
    for (int n = 0; n < perNode; ++n) {
      const blob_node node = blob_model_node(model, i);
      points.push_back({node.centre[0] + node.radius * part(random),
                        node.centre[1] + node.radius * part(random),
                        node.centre[2] + node.radius * part(random)});
    }
  return points;
}

blob_sample sampleOf(const blob_model* model, const Point& point, std::uint32_t cursor,
                     std::uint32_t flags = 0) {
  blob_sample sample;
  blob_query(model, flags, point.data(), &cursor, &sample);
  return sample;
}

TEST(BlobPose, AnswersWithTheBitsOfTheModelUntilItMoves) {
  const Model rest = fork(0.5, 0.05).build();
  const Pose pose = makePose(rest);
  for (const Point& point : pointsAround(rest.get(), 5))
    EXPECT_TRUE(sameBits(sampleOf(rest.get(), point, BLOB_NOWHERE),
                         sampleOf(blob_pose_model(pose.get()), point, BLOB_NOWHERE)));
}

// Kernel by kernel: a motion of all space, with a factor, carries the field with it.
class MovesAsAWhole : public testing::TestWithParam<blob_kernel> {};

TEST_P(MovesAsAWhole, AndSoDoItsAnswers) {
  Tree tree = fork(0.5, 0.05);
  tree.kernel = GetParam();
  tree.parameter = tree.kernel == BLOB_GAUSSIAN ? 0.5 : 0.2;
  const Model rest = tree.build();
  for (const double factor : {1.0, 1.5, 0.6}) {
    const Pose pose = makePose(rest);
    const Motion motion = someMotion(factor);
    set(pose, transformsOf(rest, motion));
    for (const Point& point : pointsAround(rest.get(), 4)) {
      const std::uint32_t node = blob_cursor_locate(rest.get(), point.data());
      const blob_sample before = sampleOf(rest.get(), point, node);
      const blob_sample after = sampleOf(blob_pose_model(pose.get()), motion.move(point), node);
      ASSERT_NEAR(after.value, before.value, 2e-5 * (1 + before.value));
      ASSERT_NEAR(after.distance, factor * before.distance, 2e-4);
      const Point normal = motion.turn({before.normal[0], before.normal[1], before.normal[2]});
      if (std::abs(before.distance) > 0.3) continue;
      for (std::size_t i = 0; i < 3; ++i) ASSERT_NEAR(after.normal[i], normal[i], 1e-3);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, MovesAsAWhole,
                         testing::Values(BLOB_CAUCHY, BLOB_GAUSSIAN, BLOB_QUARTIC,
                                         BLOB_SOFT_OBJECT));

TEST(BlobPose, NodesWithoutBlobsRideOnThoseOfTheirLender) {
  Tree tree;
  tree.addNode({0, 0, 0}, 1);
  tree.addBlob({0, 0, 0}, 0.5);
  tree.addNode({0.5, 0.1, 0}, 1, 0);
  tree.addNode({1.0, 0, 0.1}, 0.9, 1);
  const Model rest = tree.build();
  const Pose pose = makePose(rest);
  const Motion motion = someMotion();
  set(pose, transformsOf(rest, motion));
  for (const Point& point : pointsAround(rest.get(), 20)) {
    const blob_sample before = sampleOf(rest.get(), point, 2, BLOB_HOLD);
    EXPECT_NEAR(sampleOf(blob_pose_model(pose.get()), motion.move(point), 2, BLOB_HOLD).value,
                before.value, 1e-5);
  }
}

TEST(BlobPose, IsTheSameOnAllInstructions) {
  const Tree tree = bend(0.05);
  std::vector<std::vector<blob_sample>> answers;
  for (const blob_simd simd :
       {BLOB_SIMD_SCALAR, BLOB_SIMD_PORTABLE, BLOB_SIMD_AVX2, BLOB_SIMD_AVX512}) {
    const Model rest = tree.build(simd);
    const Pose pose = makePose(rest);
    blob_pose_change change;
    set(pose, bendInto(rest, 6), &change);
    std::vector<blob_sample>& samples = answers.emplace_back();
    for (const Point& point : pointsAround(blob_pose_model(pose.get()), 5))
      samples.push_back(sampleOf(blob_pose_model(pose.get()), point, BLOB_NOWHERE));
    samples.emplace_back().value = change.strain;
  }
  for (const std::vector<blob_sample>& samples : answers)
    for (std::size_t i = 0; i < samples.size(); ++i)
      ASSERT_TRUE(sameBits(samples[i], answers[0][i])) << i;
}

// A straight tube that is bent: its wall stays where a bent tube has it.
TEST(BlobPose, ABentTubeHasTheWallOfATorus) {
  constexpr double kRadius = 8;
  const Model rest = tube(40).build();
  const Pose pose = makePose(rest);
  set(pose, bendInto(rest, kRadius));
  const blob_model* bent = blob_pose_model(pose.get());
  // the same places of the tube at rest
  double worst = 0;
  for (double along = 6; along < 17; along += 0.17)
    for (double round = 0; round < 6.28; round += 0.4) {
      const double y = std::cos(round), z = std::sin(round);
      const double rests = sampleOf(rest.get(), {along, y, z}, BLOB_NOWHERE).distance;
      const double angle = along / kRadius;
      const Point point{(kRadius - y) * std::sin(angle), kRadius - (kRadius - y) * std::cos(angle),
                        z};
      const double bends = sampleOf(bent, point, BLOB_NOWHERE).distance;
      worst = std::max(worst, std::abs(bends - rests));
    }
  EXPECT_LT(worst, 0.01);
}

TEST(BlobPose, GradientIsThatOfTheValueAcrossSeams) {
  const Model rest = tube(40, 0.03).build();
  const Pose pose = makePose(rest);
  set(pose, bendInto(rest, 5));
  const blob_model* bent = blob_pose_model(pose.get());
  for (const Point& point : pointsAround(bent, 6)) {
    const std::uint32_t node = blob_cursor_locate(bent, point.data());
    const blob_sample s = sampleOf(bent, point, node);
    if (s.distance > 0.3) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      constexpr double kStep = 1e-3;
      Point low = point, high = point;
      low[i] -= kStep;
      high[i] += kStep;
      const double slope =
          (sampleOf(bent, high, node).value - sampleOf(bent, low, node).value) / (2 * kStep);
      ASSERT_NEAR(s.gradient[i], slope, 2e-3);
    }
  }
}

TEST(BlobPose, TouchingVesselsStayApart) {
  const Model rest = kissing(0.05).build();
  const Pose pose = makePose(rest), alone = makePose(rest);
  std::vector<blob_transform> transforms =
      transformsOf(rest, {{{0, 0, 0}, {0, 0, 0, 1}, 1}, {0, 0, 0}});
  for (std::size_t i = 30; i < 60; ++i) transforms[i].centre[1] -= 0.8;  // into the other vessel
  set(pose, transforms);
  for (const Point& point : pointsAround(rest.get(), 4)) {
    const std::uint32_t node = blob_cursor_locate(rest.get(), point.data());
    if (node >= 30) continue;
    EXPECT_TRUE(sameBits(sampleOf(blob_pose_model(pose.get()), point, node),
                         sampleOf(blob_pose_model(alone.get()), point, node)) ||
                std::abs(sampleOf(blob_pose_model(pose.get()), point, node).value -
                         sampleOf(blob_pose_model(alone.get()), point, node).value) < 1e-6);
  }
}

TEST(BlobPose, ASetOfSomeNodesIsThatOfAll) {
  const Model rest = fork(0.6, 0.05).build();
  const Pose whole = makePose(rest), parts = makePose(rest);
  std::vector<blob_transform> transforms = transformsOf(rest, someMotion(1.1));
  set(whole, transforms);
  std::vector<std::uint32_t> order(transforms.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  for (std::size_t first = 0; first < order.size(); first += 7) {
    std::vector<blob_transform> some;
    const std::size_t count = std::min<std::size_t>(7, order.size() - first);
    for (std::size_t i = 0; i < count; ++i) some.push_back(transforms[order[first + i]]);
    ASSERT_EQ(blob_pose_set(parts.get(), count, &order[first], some.data(), nullptr), BLOB_OK);
  }
  for (const Point& point : pointsAround(blob_pose_model(whole.get()), 4))
    ASSERT_TRUE(sameBits(sampleOf(blob_pose_model(whole.get()), point, BLOB_NOWHERE),
                         sampleOf(blob_pose_model(parts.get()), point, BLOB_NOWHERE)));
}

TEST(BlobPose, LocatesTheNodeOfLeastPower) {
  const Model rest = helix(3000, 0.02).build();
  const Pose pose = makePose(rest);
  std::vector<blob_transform> transforms = transformsOf(rest, someMotion(1.2));
  set(pose, transforms);
  std::vector<std::uint32_t> some{5, 700, 701, 2999};
  for (const std::uint32_t i : some) transforms[i].centre[2] += 40;
  ASSERT_EQ(blob_pose_set(pose.get(), 2, &some[1], &transforms[700], nullptr), BLOB_OK);
  const blob_model* model = blob_pose_model(pose.get());
  std::mt19937 random(9);
  for (int n = 0; n < 300; ++n) {
    const blob_node near = blob_model_node(model, static_cast<std::uint32_t>(random() % 3000));
    std::normal_distribution<double> step(0, 2);
    const Point point{near.centre[0] + step(random), near.centre[1] + step(random),
                      near.centre[2] + step(random)};
    double least = 1e300;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      const blob_node node = blob_model_node(model, i);
      double power = -node.radius * node.radius;
      for (std::size_t k = 0; k < 3; ++k)
        power += (point[k] - node.centre[k]) * (point[k] - node.centre[k]);
      least = std::min(least, power);
    }
    const blob_node found = blob_model_node(model, blob_cursor_locate(model, point.data()));
    double power = -found.radius * found.radius;
    for (std::size_t k = 0; k < 3; ++k)
      power += (point[k] - found.centre[k]) * (point[k] - found.centre[k]);
    ASSERT_NEAR(power, least, 1e-3);
  }
}

TEST(BlobPose, NeitherSettingNorQueryingAllocates) {
  const Model rest = fork(0.6, 0.05).build();
  const Pose pose = makePose(rest);
  const std::vector<blob_transform> transforms = transformsOf(rest, someMotion());
  std::vector<Point> centres;
  for (const blob_transform& t : transforms)
    centres.push_back({t.centre[0], t.centre[1], t.centre[2]});
  const std::uint32_t two[2] = {3, 4};
  const std::size_t before = countAllocations();
  blob_pose_change change;
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(blob_pose_set(pose.get(), transforms.size(), nullptr, transforms.data(), &change),
              BLOB_OK);
    EXPECT_EQ(blob_pose_set(pose.get(), 2, two, transforms.data(), &change), BLOB_OK);
    EXPECT_EQ(blob_pose_set_centres(pose.get(), centres.size(), nullptr,
                                    reinterpret_cast<const double(*)[3]>(centres.data()), &change),
              BLOB_OK);
    double velocity[3];
    blob_pose_velocity(pose.get(), pose.get(), 1, 0, centres[5].data(), nullptr, velocity);
  }
  EXPECT_EQ(countAllocations(), before);
}

TEST(BlobPose, StatesTheStretchOfAnEdgeAndTheTurnOfItsEnds) {
  const Model rest = tube(20).build();  // nodes 0.6 apart, radius 1
  const Pose pose = makePose(rest);
  std::vector<blob_transform> transforms = transformsOf(rest, someMotion());
  blob_pose_change change;
  set(pose, transforms, &change);
  EXPECT_NEAR(change.strain, 0, 1e-5);  // as a whole
  transforms = transformsOf(rest, {{{0, 0, 0}, {0, 0, 0, 1}, 1}, {0, 0, 0}});
  for (std::size_t i = 10; i < 20; ++i) transforms[i].centre[0] += 0.06;
  set(pose, transforms, &change);
  EXPECT_NEAR(change.strain, 0.1, 1e-4);
  EXPECT_NEAR(blob_pose_strain(pose.get()), 0.1, 1e-4);
  // a turn of 0.03 over 0.6 mm at a wall of radius 1, and the axis' own way of bending
  set(pose, bendInto(rest, 20), &change);
  EXPECT_NEAR(change.strain, 0.05 + 0.015, 1e-3);
  EXPECT_FALSE(change.stale);
}

TEST(BlobPose, MakesTablesAnewBeyondTheLimit) {
  const Model rest = tube(40).build();
  const Pose pose = makePose(rest, true), lazy = makePose(rest, false);
  blob_pose_change change;
  set(pose, bendInto(rest, 20), &change);
  EXPECT_FALSE(change.renewed);
  set(lazy, bendInto(rest, 1.5), &change);
  EXPECT_TRUE(change.stale);
  EXPECT_GT(change.strain, 0.25);
  set(pose, bendInto(rest, 1.5), &change);
  EXPECT_TRUE(change.renewed);
  EXPECT_FALSE(change.stale);
  EXPECT_NEAR(blob_pose_strain(pose.get()), 0, 1e-5);
  // the neighbours are those of a model that is made in this shape
  Tree bent = tube(40);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const blob_transform t = blob_pose_node(pose.get(), i);
    for (std::size_t k = 0; k < 3; ++k) bent.centre[i][k] = static_cast<float>(t.centre[k]);
  }
  const Model made = bent.build();
  bool differs = false;
  for (std::uint32_t i = 0; i < 40; ++i) {
    std::uint32_t expected[64], found[64], atRest[64];
    const std::size_t count = blob_model_neighbours(made.get(), i, expected, 64);
    ASSERT_EQ(blob_model_neighbours(blob_pose_model(pose.get()), i, found, 64), count);
    EXPECT_TRUE(std::equal(found, found + count, expected));
    differs = differs || blob_model_neighbours(rest.get(), i, atRest, 64) != count;
  }
  EXPECT_TRUE(differs) << "the bend is too wide to have other neighbours";
  EXPECT_EQ(blob_pose_renew(lazy.get()), BLOB_OK);
  EXPECT_NEAR(blob_pose_strain(lazy.get()), 0, 1e-5);
}

TEST(BlobPose, SetsRotationsFromCentres) {
  const Model rest = tube(40).build();
  const Pose pose = makePose(rest), exact = makePose(rest);
  const std::vector<blob_transform> transforms = bendInto(rest, 10);
  set(exact, transforms);
  std::vector<Point> centres;
  for (const blob_transform& t : transforms)
    centres.push_back({t.centre[0], t.centre[1], t.centre[2]});
  ASSERT_EQ(blob_pose_set_centres(pose.get(), 40, nullptr,
                                  reinterpret_cast<const double(*)[3]>(centres.data()), nullptr),
            BLOB_OK);
  for (std::uint32_t i = 1; i < 39; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(blob_pose_node(pose.get(), i).rotation[k], transforms[i].rotation[k], 1e-6);
  for (const Point& point : pointsAround(blob_pose_model(exact.get()), 2)) {
    const blob_sample a = sampleOf(blob_pose_model(pose.get()), point, BLOB_NOWHERE);
    const blob_sample b = sampleOf(blob_pose_model(exact.get()), point, BLOB_NOWHERE);
    if (a.node <= 1 || a.node >= 38) continue;
    EXPECT_NEAR(a.distance, b.distance, 1e-4);
  }
}

TEST(BlobPose, WeightsAreThoseOfTheField) {
  const Model rest = fork(0.6, 0.05).build();
  for (const Point& point : pointsAround(rest.get(), 6)) {
    std::uint32_t cursor = BLOB_NOWHERE, nodes[24];
    double weights[24], sum = 0, value = 0;
    const std::size_t count =
        blob_query_weights(rest.get(), 0, point.data(), &cursor, nodes, weights, 24);
    ASSERT_GE(count, 1U);
    for (std::size_t i = 0; i < count; ++i) {
      sum += weights[i];
      value += weights[i] * sampleOf(rest.get(), point, nodes[i], BLOB_LOCAL | BLOB_HOLD).value;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(value, sampleOf(rest.get(), point, cursor).value, 1e-5);
  }
}

TEST(BlobPose, VelocityAtTheWallIsTheSpeedOfTheWall) {
  const Model rest = tube(40).build();
  const Pose before = makePose(rest), after = makePose(rest);
  constexpr double kSeconds = 1e-3;
  set(before, bendInto(rest, 12));
  std::vector<blob_transform> transforms = bendInto(rest, 11.99);
  for (blob_transform& t : transforms) t.factor = 1.0005;
  set(after, transforms);
  int compared = 0;
  for (const Point& around : pointsAround(blob_pose_model(after.get()), 4)) {
    std::uint32_t cursor = BLOB_NOWHERE;
    blob_nearest_point wall;
    blob_nearest(blob_pose_model(after.get()), 0, around.data(), &cursor, 0, 0, &wall);
    if (wall.converged == 0 || wall.node < 3 || wall.node > 36) continue;
    double velocity[3], speed = 0;
    blob_pose_velocity(after.get(), before.get(), kSeconds, 0, wall.point, &cursor, velocity);
    for (std::size_t i = 0; i < 3; ++i) speed += velocity[i] * wall.normal[i];
    // the way of the wall through a fixed point
    const Point at{wall.point[0], wall.point[1], wall.point[2]};
    const double way =
        sampleOf(blob_pose_model(before.get()), at, wall.node, BLOB_DISTANCE_EXACT).distance -
        sampleOf(blob_pose_model(after.get()), at, wall.node, BLOB_DISTANCE_EXACT).distance;
    ASSERT_NEAR(speed, way / kSeconds, 0.005 * norm(velocity) + 0.02);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(BlobPose, BlendsBetweenTwo) {
  const Model rest = tube(20).build();
  const Pose from = makePose(rest), to = makePose(rest), middle = makePose(rest),
             expected = makePose(rest);
  Motion turn{{{0, 0, 0}, {0, 0, 0, 1}, 1}, {0, 0, 0}};
  turn.transform.rotation[2] = std::sin(0.5);
  turn.transform.rotation[3] = std::cos(0.5);
  turn.transform.factor = 2;
  set(to, transformsOf(rest, turn));
  ASSERT_EQ(blob_pose_blend(middle.get(), from.get(), to.get(), 0.25, nullptr), BLOB_OK);
  const blob_transform t = blob_pose_node(middle.get(), 10), end = blob_pose_node(to.get(), 10);
  EXPECT_NEAR(t.rotation[2], std::sin(0.125), 1e-12);
  EXPECT_NEAR(t.rotation[3], std::cos(0.125), 1e-12);
  EXPECT_DOUBLE_EQ(t.factor, 1.25);
  const double start = blob_model_node(rest.get(), 10).centre[0];
  EXPECT_NEAR(t.centre[0], start + 0.25 * (end.centre[0] - start), 1e-5);
  // the shorter arc, whichever sign a quaternion has
  blob_transform back = end;
  for (double& x : back.rotation) x = -x;
  const blob_transform first = blob_pose_node(from.get(), 10);
  EXPECT_NEAR(blob_transform_between(&first, &back, 0.25).rotation[3], std::cos(0.125), 1e-12);
}

std::vector<char> bytesOf(const std::string& file) {
  std::ifstream in(std::string(LUMEN_CONFORMANCE) + "/valid/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(BlobMotion, IsReadFromACaseAndRepeats) {
  const std::vector<char> bytes = bytesOf("motion-periodic.lumen");
  ASSERT_FALSE(bytes.empty());
  blob_model* model = nullptr;
  ASSERT_EQ(blob_model_open_bytes(bytes.data(), bytes.size(), nullptr, &model), BLOB_OK);
  const Model rest(model);
  blob_motion* motion = nullptr;
  ASSERT_EQ(blob_motion_open_bytes(bytes.data(), bytes.size(), nullptr, &motion), BLOB_OK);
  const blob_motion_info info = blob_motion_describe(motion);
  EXPECT_GT(info.period, info.last - info.first);
  EXPECT_GE(info.time_count, 2U);
  EXPECT_GE(info.node_count, 1U);
  const Pose now = makePose(rest), later = makePose(rest);
  const double time = info.first + 0.3 * info.period;
  ASSERT_EQ(blob_pose_set_time(now.get(), motion, time, nullptr), BLOB_OK);
  ASSERT_EQ(blob_pose_set_time(later.get(), motion, time + 3 * info.period, nullptr), BLOB_OK);
  double moved = 0;
  for (std::uint32_t i = 0; i < countNodes(rest.get()); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(blob_pose_node(now.get(), i).centre[k], blob_pose_node(later.get(), i).centre[k],
                  1e-5);
      moved = std::max(moved, std::abs(blob_pose_node(now.get(), i).centre[k] -
                                       blob_model_node(rest.get(), i).centre[k]));
    }
  EXPECT_GT(moved, 0.01);
  EXPECT_EQ(blob_pose_set_time(now.get(), motion, std::nan(""), nullptr), BLOB_ERROR_RANGE);
  const Model another = tube(20).build();
  const Pose stranger = makePose(another);
  EXPECT_EQ(blob_pose_set_time(stranger.get(), motion, 0, nullptr), BLOB_ERROR_ARGUMENT);
  blob_motion_close(motion);
}

TEST(BlobMotion, IsMissingInACaseThatRests) {
  const std::vector<char> bytes = bytesOf("golden-1-1.lumen");
  ASSERT_FALSE(bytes.empty());
  char message[200] = "";
  blob_open_def def = blob_open_def_default();
  def.message = message;
  def.message_size = sizeof message;
  blob_motion* motion = nullptr;
  EXPECT_EQ(blob_motion_open_bytes(bytes.data(), bytes.size(), &def, &motion),
            BLOB_ERROR_NO_MOTION);
  EXPECT_EQ(motion, nullptr);
  EXPECT_NE(std::string(message).find("no motion"), std::string::npos);
}

TEST(BlobPose, SegmentsHitTheWallWhereItIsNow) {
  const Model rest = tube(20).build();
  const Pose pose = makePose(rest);
  Motion away{{{0, 0, 0}, {0, 0, 0, 1}, 1}, {0, 0, 0}};
  away.transform.centre[1] = 50;
  set(pose, transformsOf(rest, away));
  const double from[3] = {6, 50, 0}, to[3] = {6, 53, 0};
  std::uint32_t cursor = 10;
  blob_hit hit;
  blob_segment_hit(blob_pose_model(pose.get()), 0, from, to, &cursor, 0, 0, &hit);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.point[1], 51, 0.02);
}

TEST(BlobPose, RefusesWhatIsNoPoseAndStaysAsItWas) {
  const Model rest = tube(20).build();
  const Pose pose = makePose(rest);
  std::vector<blob_transform> transforms = transformsOf(rest, someMotion());
  const Point point{5, 0.5, 0};
  const blob_sample before = sampleOf(blob_pose_model(pose.get()), point, BLOB_NOWHERE);
  const std::uint32_t outside[1] = {20};
  EXPECT_EQ(blob_pose_set(pose.get(), 1, outside, transforms.data(), nullptr), BLOB_ERROR_TOPOLOGY);
  EXPECT_EQ(blob_pose_set(pose.get(), 21, nullptr, transforms.data(), nullptr),
            BLOB_ERROR_TOPOLOGY);
  const auto refuses = [&](double blob_transform::*number, double value) {
    std::vector<blob_transform> wrong = transforms;
    wrong[7].*number = value;
    EXPECT_EQ(blob_pose_set(pose.get(), 20, nullptr, wrong.data(), nullptr), BLOB_ERROR_RANGE);
  };
  for (const double factor : {0.0, -1.0, 2e3, std::nan("")})
    refuses(&blob_transform::factor, factor);
  std::vector<blob_transform> wrong = transforms;
  std::fill_n(wrong[19].rotation, 4, 0.0);
  EXPECT_EQ(blob_pose_set(pose.get(), 20, nullptr, wrong.data(), nullptr), BLOB_ERROR_RANGE);
  wrong = transforms;
  wrong[3].centre[1] = std::nan("");
  EXPECT_EQ(blob_pose_set(pose.get(), 20, nullptr, wrong.data(), nullptr), BLOB_ERROR_RANGE);
  const double centre[1][3] = {{0, 2e6, 0}};
  EXPECT_EQ(blob_pose_set_centres(pose.get(), 1, nullptr, centre, nullptr), BLOB_ERROR_RANGE);
  EXPECT_TRUE(sameBits(before, sampleOf(blob_pose_model(pose.get()), point, BLOB_NOWHERE)));

  blob_pose* none = pose.get();
  EXPECT_EQ(blob_pose_create(blob_pose_model(pose.get()), nullptr, &none), BLOB_ERROR_ARGUMENT);
  EXPECT_EQ(none, nullptr);
  EXPECT_EQ(blob_pose_create(nullptr, nullptr, &none), BLOB_ERROR_ARGUMENT);
  const Model another = tube(20).build();
  const Pose stranger = makePose(another);
  EXPECT_EQ(blob_pose_blend(pose.get(), pose.get(), stranger.get(), 0.5, nullptr),
            BLOB_ERROR_ARGUMENT);
  EXPECT_TRUE(std::isnan(blob_pose_node(pose.get(), 20).factor));
}

}  // namespace
}  // namespace lumen::blob::test
