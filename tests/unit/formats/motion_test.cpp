// SPDX-License-Identifier: Apache-2.0
// Motions: both encodings, rules, and poses between the times.
#include "formats/case/motion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "formats/case/case_field.h"
#include "formats/container/bytes.h"
#include "formats/field/posed_field.h"
#include "formats/view/limits.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using field::carried;
using field::NodePose;
using field::Quaternion;
using field::rotated;

using test::Bytes;
using test::codeOf;
using test::dataOf;
using test::entryOf;
using test::movingCase;

constexpr double kPi = 3.14159265358979323846;

// The rotation by `angle` about z.
Quaternion aboutZ(double angle) {
  return {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
}

// One node at rest at the origin that moves along x and turns about z by a right angle, from 0 s
// to 1 s.
Case turningCase(double period) {
  Case value = test::smallestCase();
  value.tree.centre[0] = {0, 0, 0};
  const float half = std::sqrt(0.5f);
  value.motion = Motion{{0, 1}, period, {0}, {Pose{}, Pose{{4, 0, 0}, {0, 0, half, half}, 3}}};
  return value;
}

NodePose poseAt(const Case& value, double time) {
  return posesAt(value.tree, *value.motion, time).front();
}

TEST(Motion, IsGivenBackByTheBinaryEncoding) {
  for (const bool compress : {false, true}) {
    const auto decoded = decodeBinary(encodeBinary(movingCase(), {compress, 0}));
    ASSERT_TRUE(decoded) << decoded.error().text();
    EXPECT_EQ(*decoded, movingCase());
  }
}

TEST(Motion, IsGivenBackByJson) {
  const auto decoded = decodeJson(encodeJson(movingCase()));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, movingCase());
  EXPECT_EQ(encodeBinary(*decoded), encodeBinary(movingCase()));
}

TEST(Motion, LiesInItsChunkAsTheSpecificationStates) {
  const Bytes file = encodeBinary(movingCase());
  const std::size_t at = dataOf(file, "MOVE");
  EXPECT_EQ(loadLittle<std::uint64_t>(&file[entryOf(file, "MOVE") + 16]),
            16u + 8 * 3 + 4 * 3 + 32 * 9);
  EXPECT_EQ(file[entryOf(file, "MOVE") + 6], std::byte{0});  // neither critical nor independent
  EXPECT_EQ(loadLittle<std::uint32_t>(&file[at]), 3u);
  EXPECT_EQ(loadLittle<double>(&file[at + 8]), 0.9);
  EXPECT_EQ(loadLittle<double>(&file[at + 16 + 8]), 0.25);
  EXPECT_EQ(loadLittle<std::uint32_t>(&file[at + 16 + 24 + 8]), 5u);
  const std::size_t pose = at + 16 + 24 + 12 + 32 * 3;  // of node 1 at the second time
  EXPECT_EQ(loadLittle<float>(&file[pose]), 0.25f);
  EXPECT_EQ(loadLittle<float>(&file[pose + 12]), 0.6f);
  EXPECT_EQ(loadLittle<float>(&file[pose + 24]), 0.8f);
  EXPECT_EQ(loadLittle<float>(&file[pose + 28]), 1.125f);
}

// spec: M54
TEST(Motion, AloneRaisesTheVersionOfAFile) {
  const Bytes still = encodeBinary(test::fullCase()), moving = encodeBinary(movingCase());
  EXPECT_EQ(still[11], std::byte{1});
  EXPECT_EQ(moving[11], std::byte{2});
  EXPECT_EQ(moving[13], std::byte{0});
  EXPECT_NE(encodeJson(test::fullCase()).find("\"version\": \"1.1\""), std::string::npos);
  EXPECT_NE(encodeJson(movingCase()).find("\"version\": \"1.2\""), std::string::npos);
}

TEST(Motion, IsTakenFromTheOtherChunksOfAnOlderProgram) {
  for (const bool compress : {false, true}) {
    const Bytes file = encodeBinary(movingCase(), {compress, 0});
    const std::size_t entry = entryOf(file, "MOVE"), at = dataOf(file, "MOVE");
    const auto size = loadLittle<std::uint64_t>(&file[entry + 16]);
    Case older = test::richCase();
    OtherChunk chunk{"MOVE", 1, false, static_cast<std::uint8_t>(file[entry + 7]), 0, {}};
    chunk.rawSize = loadLittle<std::uint64_t>(&file[entry + 24]);
    chunk.bytes.assign(file.begin() + static_cast<std::ptrdiff_t>(at),
                       file.begin() + static_cast<std::ptrdiff_t>(at + size));
    older.otherChunks = {chunk};
    const auto read = decodeJson(encodeJson(older));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(*read, movingCase());
    older.otherChunks[0].bytes.pop_back();
    if (!compress) --older.otherChunks[0].rawSize;
    const auto damaged = decodeJson(encodeJson(older));
    ASSERT_FALSE(damaged);
    EXPECT_EQ(codeOf(damaged), "JSON_CHUNK_DATA");
    EXPECT_EQ(damaged.error().place(), "/otherChunks/0");
  }
}

struct MotionBreachRow {
  const char* name;
  void (*change)(Motion&);
  const char* code;
  const char* place;
  std::size_t offset;  ///< in the chunk
};

constexpr std::size_t kNodesAt = 16 + 8 * 3, kPosesAt = kNodesAt + 4 * 3;

const MotionBreachRow kBreaches[] = {
    {"time_equal", [](Motion& m) { m.time[1] = m.time[0]; }, "MOTION_TIME", "/motion/time/1", 24},
    {"time_infinite", [](Motion& m) { m.time[2] = INFINITY; }, "NOT_FINITE", "/motion/time/2", 32},
    {"period_as_long", [](Motion& m) { m.period = m.time[2] - m.time[0]; }, "MOTION_PERIOD",
     "/motion/period", 8},
    {"period_negative", [](Motion& m) { m.period = -1; }, "MOTION_PERIOD", "/motion/period", 8},
    {"node_beyond", [](Motion& m) { m.node[2] = 6; }, "MOTION_NODE", "/motion/node/2",
     kNodesAt + 8},
    {"node_twice", [](Motion& m) { m.node[1] = 1; }, "MOTION_NODE", "/motion/node/1", kNodesAt + 4},
    {"centre_nan", [](Motion& m) { m.pose[4].centre.y = test::kNan; }, "NOT_FINITE",
     "/motion/centre/1/1/1", kPosesAt + 32 * 4 + 4},
    {"rotation_long", [](Motion& m) { m.pose[3].rotation[3] = 0.802f; }, "MOTION_ROTATION",
     "/motion/rotation/1/0", kPosesAt + 32 * 3 + 12},
    {"rotation_zero",
     [](Motion& m) {
       m.pose[8].rotation = {0, 0, 0, 0};
     },
     "MOTION_ROTATION", "/motion/rotation/2/2", kPosesAt + 32 * 8 + 12},
    {"rotation_nan", [](Motion& m) { m.pose[0].rotation[1] = test::kNan; }, "NOT_FINITE",
     "/motion/rotation/0/0/1", kPosesAt + 16},
    {"factor_zero", [](Motion& m) { m.pose[1].factor = 0; }, "MOTION_FACTOR", "/motion/factor/0/1",
     kPosesAt + 32 + 28}};

class MotionBreach : public testing::TestWithParam<MotionBreachRow> {};

// spec: M2, M39
TEST_P(MotionBreach, IsNamedWithItsPlace) {
  Case value = movingCase();
  GetParam().change(*value.motion);
  const Status valid = validate(value);
  ASSERT_FALSE(valid);
  EXPECT_EQ(codeOf(valid), GetParam().code) << valid.error().text();
  EXPECT_EQ(valid.error().pointer, GetParam().place);
  const Bytes file = encodeBinary(value);
  const auto decoded = decodeBinary(file);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(codeOf(decoded), GetParam().code);
  EXPECT_EQ(decoded.error().offset, dataOf(file, "MOVE") + GetParam().offset);
}

INSTANTIATE_TEST_SUITE_P(All, MotionBreach, testing::ValuesIn(kBreaches),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Motion, WithoutATimeIsRefused) {
  Case value = movingCase();
  value.motion->time.clear();
  value.motion->pose.clear();
  EXPECT_EQ(codeOf(validate(value)), "MOTION_TIME");
}

TEST(Motion, OfMoreTimesThanTheLimitIsRefused) {
  Case value = movingCase();
  value.motion->period = 0;
  for (std::size_t i = 3; i <= kMaxTimes; ++i) {
    value.motion->time.push_back(static_cast<double>(i));
    value.motion->pose.insert(value.motion->pose.end(), 3, Pose{});
  }
  EXPECT_EQ(codeOf(validate(value)), "LIMIT");
  EXPECT_EQ(codeOf(decodeBinary(encodeBinary(value))), "LIMIT");
}

// spec: M26, M42
TEST(Motion, OfAnotherSizeThanItsCountsIsRefused) {
  for (const std::uint32_t nodes : {0u, 2u, 4u, 0xffffffffu}) {
    Bytes file = encodeBinary(movingCase());
    storeLittle(&file[dataOf(file, "MOVE") + 4], nodes);
    test::resign(file);
    EXPECT_EQ(codeOf(decodeBinary(file)), nodes > 4 ? "LIMIT" : "CHUNK_LENGTH") << nodes;
  }
}

struct MotionText {
  const char* name;
  const char* from;
  const char* to;
  const char* code;
  const char* place;
};

class MotionJson : public testing::TestWithParam<MotionText> {};

TEST_P(MotionJson, IsRefused) {
  std::string text = encodeJson(movingCase());
  const std::size_t at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos) << text;
  text.replace(at, std::string(GetParam().from).size(), GetParam().to);
  const auto result = decodeJson(text);
  ASSERT_FALSE(result);
  EXPECT_EQ(codeOf(result), GetParam().code) << result.error().text();
  EXPECT_EQ(result.error().place(), GetParam().place);
}

INSTANTIATE_TEST_SUITE_P(
    All, MotionJson,
    testing::Values(
        MotionText{"period_zero", "\"period\": 0.9", "\"period\": 0", "MOTION_PERIOD",
                   "/motion/period"},
        MotionText{"no_time", "\"time\": [0.1, 0.25, 0.7],", "", "JSON_KEY_MISSING", "/motion"},
        MotionText{"key_unknown", "\"period\": 0.9", "\"speed\": 0.9", "JSON_KEY_UNKNOWN",
                   "/motion/speed"},
        MotionText{"row_missing", "[[0.6,0,0,0.8], [0.6,0,0,0.8], [0.6,0,0,0.8]],", "",
                   "ARRAY_LENGTH", "/motion/rotation"},
        MotionText{"row_short", "[1.125, 1.125, 1.125]", "[1.125, 1.125]", "ARRAY_LENGTH",
                   "/motion/factor/1"},
        MotionText{"not_rows", "[1.125, 1.125, 1.125]", "1.125", "JSON_TYPE", "/motion/factor/1"},
        MotionText{"quaternion_of_three", "[0.6,0,0,0.8]", "[0.6,0,0.8]", "JSON_TYPE",
                   "/motion/rotation/1/0/3"},
        MotionText{"text_in_a_row", "[1.125, 1.125, 1.125]", "[1.125, \"1\", 1.125]", "JSON_TYPE",
                   "/motion/factor/1/1"},
        MotionText{"number_beyond_f32", "[0.6,0,0,0.8]", "[0.6,0,1e39,0.8]", "NUMBER_RANGE",
                   "/motion/rotation/1/0/2"},
        MotionText{"time_beyond_f64", "[0.1, 0.25, 0.7]", "[0.1, 0.25, 1e999]", "NUMBER_RANGE",
                   "/motion/time/2"}),
    [](const auto& test) { return std::string(test.param.name); });

// spec: M52
TEST(Poses, AreLinearInTimeAndTurnAlongTheShorterArc) {
  const NodePose pose = poseAt(turningCase(0), 0.25);
  EXPECT_NEAR(pose.centre.x, 1, 1e-12);
  EXPECT_NEAR(pose.factor, 1.5, 1e-12);
  EXPECT_NEAR(field::angleBetween(pose.rotation, {0, 0, 0, 1}), kPi / 8, 1e-7);
  Case other = turningCase(0);
  for (float& x : other.motion->pose[1].rotation) x = -x;  // the same rotation
  EXPECT_NEAR(field::angleBetween(poseAt(other, 0.25).rotation, pose.rotation), 0, 1e-7);
}

// spec: M52
TEST(Poses, StayBeforeTheFirstTimeAndAfterTheLast) {
  EXPECT_EQ(poseAt(turningCase(0), -5).centre.x, 0);
  EXPECT_EQ(poseAt(turningCase(0), 5).centre.x, 4);
}

// spec: M52
TEST(Poses, ReturnToTheFirstAfterAPeriod) {
  const Case value = turningCase(3);
  EXPECT_NEAR(poseAt(value, 2).centre.x, 2, 1e-12);
  EXPECT_NEAR(poseAt(value, 2.5).centre.x, 1, 1e-12);
  EXPECT_NEAR(poseAt(value, 3).centre.x, 0, 1e-12);
  EXPECT_NEAR(poseAt(value, -0.5).centre.x, 1, 1e-12);
  EXPECT_NEAR(poseAt(value, 3e6 + 0.5).centre.x, 2, 1e-8);
}

// spec: M50
TEST(Poses, DivideARotationByItsLength) {
  Case value = turningCase(0);
  for (float& x : value.motion->pose[1].rotation) x *= 1.0005f;
  ASSERT_TRUE(validate(value));
  const field::Vec turned = rotated(poseAt(value, 1).rotation, {1, 0, 0});
  EXPECT_NEAR(turned.x, 0, 1e-7);
  EXPECT_NEAR(turned.y, 1, 1e-12);
}

TEST(Poses, CarryPointsAboutTheCentreAtRest) {
  const NodePose pose{{10, 0, 0}, aboutZ(kPi / 2), 2};
  const field::Vec to = carried(pose, {1, 1, 1}, {2, 1, 4});
  EXPECT_NEAR(to.x, 10, 1e-12);
  EXPECT_NEAR(to.y, 2, 1e-12);
  EXPECT_NEAR(to.z, 6, 1e-12);
}

TEST(Slerp, AgreesWithTheFormulaForAnglesSmallAndLarge) {
  for (const double angle : {1e-9, 1e-3, 1.0, kPi / 2, 3.1})
    for (const double u : {0.0, 0.125, 0.5, 0.9, 1.0}) {
      const Quaternion q = field::slerp(aboutZ(0.3), aboutZ(0.3 + angle), u),
                       want = aboutZ(0.3 + u * angle);
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(q[i], want[i], 1e-15) << angle << " " << u;
    }
}

// The rich case, turned and shifted as a whole.
Case carriedCase(const NodePose& body) {
  Case value = test::richCase();
  Motion& motion = value.motion.emplace();
  motion.time = {0};
  for (std::uint32_t i = 0; i < 6; ++i) {
    Vec3f& o = value.tree.centre[i];
    if (i == 5) o.y = 4;  // the sample is 16 km long
    const field::Vec to = carried(body, {0, 0, 0}, {o.x, o.y, o.z});
    Pose pose{{float(to.x), float(to.y), float(to.z)}, {}, 1};
    for (std::size_t c = 0; c < 4; ++c) pose.rotation[c] = float(body.rotation[c]);
    motion.node.push_back(i);
    motion.pose.push_back(pose);
  }
  return value;
}

const NodePose kBody{{3, -2, 1}, {0, 0.28, 0.0, 0.96}, 1};

// spec: M51
TEST(PosedField, IsThatOfTheCaseAtRestWhereTheWholeTreeMovesAsARigidBody) {
  const Case value = carriedCase(kBody);
  const field::BlendedField rest = caseField(value);
  const field::PosedField posed(rest, treeViewOf(value.tree),
                                posesAt(value.tree, *value.motion, 0));
  for (const field::Vec& point : {field::Vec{0.3, 0.2, 1.4}, {1.9, 0.1, 2.2}, {0.2, 3.4, 1.1}}) {
    const field::Vec moved = carried(kBody, {0, 0, 0}, point);
    const std::uint32_t node = rest.locate(point);
    EXPECT_EQ(posed.follow(moved, 0), rest.follow(point, 0));
    const field::Jet<1> want = rest.blended(point, node), have = posed.blended(moved, node);
    EXPECT_NEAR(have.value, want.value, 1e-6);
    const field::Vec slope =
        rotated(kBody.rotation, {want.gradient[0], want.gradient[1], want.gradient[2]});
    EXPECT_NEAR(have.gradient[0], slope.x, 2e-6);
    EXPECT_NEAR(have.gradient[2], slope.z, 2e-6);
  }
}

// spec: M51
TEST(PosedField, HasTheGradientOfItsValueWhereNodesTurnAndGrowApart) {
  Case value = movingCase();
  value.tree.centre[5].y = 4;
  for (Pose& pose : value.motion->pose)
    if (pose.centre.y > 100) pose.centre.y = 4;
  const field::BlendedField rest = caseField(value);
  const field::PosedField posed(rest, treeViewOf(value.tree),
                                posesAt(value.tree, *value.motion, 0.2));
  const field::Vec point{0.3, 0.4, 1.7};
  const std::uint32_t node = posed.locate(point);
  const field::Jet<1> f = posed.blended(point, node);
  const double step = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    const field::Vec by{axis == 0 ? step : 0, axis == 1 ? step : 0, axis == 2 ? step : 0};
    const double slope =
        (posed.blended(point + by, node).value - posed.blended(point - by, node).value) /
        (2 * step);
    EXPECT_NEAR(f.gradient[axis], slope, 1e-7);
  }
}

TEST(Strain, IsNoneWhereTheWholeTreeMovesAsARigidBody) {
  const Case value = carriedCase(kBody);
  EXPECT_LT(motionFigures(value.tree, *value.motion).strain, 1e-6);
}

TEST(Strain, IsTheGreatestOfStretchAndTurn) {
  Case value = test::longCase(2, 0, 0);
  value.tree.centre = {{0, 0, 0}, {0, 0, 2}};
  value.tree.radius = {1, 3};
  const auto half = static_cast<float>(0.05);
  value.motion = Motion{{0, 1},
                        0,
                        {1},
                        {Pose{{0, 0, 2.5f}, {0, 0, 0, 1}, 1},
                         Pose{{0, 0, 2}, {0, 0, std::sin(half), std::cos(half)}, 1}}};
  const MotionFigures figures = motionFigures(value.tree, *value.motion);
  EXPECT_NEAR(figures.displacement, 0.5, 1e-6);
  EXPECT_NEAR(figures.strain, 0.25, 1e-6);  // a turn of 0.1 has 3 * 0.1 / 2
  EXPECT_NEAR(figures.speed, 0.5, 1e-6);
  value.motion->period = 1.25;  // back in a quarter of a second
  EXPECT_NEAR(motionFigures(value.tree, *value.motion).speed, 2, 1e-6);
}

// spec: M53
TEST(KeepMotionOf, RenamesTheNodesThatStayAndDropsTheOthers) {
  Case value = movingCase();
  keepMotionOf(value.motion, {true, false, true, true, true, true}, {0, 0, 1, 2, 3, 4});
  ASSERT_TRUE(value.motion);
  EXPECT_EQ(value.motion->node, (std::vector<std::uint32_t>{1, 4}));
  ASSERT_EQ(value.motion->pose.size(), 6u);
  EXPECT_EQ(value.motion->pose[3], movingCase().motion->pose[5]);
  keepMotionOf(value.motion, {true, false, true, true, false}, {0, 0, 1, 2, 0});
  EXPECT_FALSE(value.motion);
}

}  // namespace
}  // namespace lumen::formats
