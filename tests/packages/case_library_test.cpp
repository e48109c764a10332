// SPDX-License-Identifier: Apache-2.0
// The installed interface of cases, in a program that has nothing of lumen but its headers and its
// shared library.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lumen/case.hpp"

namespace {

using lumen::CaseError;
using lumen::VesselCase;

const float kTrunk[3][3] = {{0, 0, 0}, {0, 0, 2}, {0, 0, 5}};
const float kTwig[2][3] = {{2, 0, 2}, {4, 0, 2}};
const float kLeaf[1][3] = {{6, 0, 2}};
const float kWide[3] = {2, 1.5f, 1}, kThin[2] = {1, 0.5f}, kThinnest[1] = {0.25f};

// trunk of nodes 0 to 2; twig of nodes 3 and 4 at node 1; leaf, node 5, at node 4.
VesselCase threeVessels() {
  VesselCase value;
  value.appendBranch("trunk", -1, 3, kTrunk, kWide);
  value.appendBranch("twig", 1, 2, kTwig, kThin);
  value.appendBranch("leaf", 4, 1, kLeaf, kThinnest);
  return value;
}

lumen_case_fault faultOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const CaseError& error) {
    EXPECT_NE(error.status(), LUMEN_CASE_OK);
    return error.fault();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(CaseLibrary, DerivesParentsDirectionsAndHeights) {
  const VesselCase value = threeVessels();
  const lumen_case_nodes nodes = value.nodes();
  ASSERT_EQ(nodes.count, 6u);
  EXPECT_EQ(std::vector<std::int32_t>(nodes.parent, nodes.parent + 6),
            (std::vector<std::int32_t>{-1, 0, 1, 1, 3, 4}));
  EXPECT_EQ(std::vector<std::uint32_t>(nodes.branch, nodes.branch + 6),
            (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 2}));
  EXPECT_EQ(nodes.direction[1][2], 1);
  EXPECT_EQ(nodes.direction[3][0], 1);
  // twice the mean of the edges of 2 and 3 mm; the radius of the only node of its branch
  EXPECT_EQ(nodes.height[1], 5);
  EXPECT_EQ(nodes.height[5], 0.25f);
  EXPECT_EQ(nodes.inlier_rate, nullptr);
}

TEST(CaseLibrary, WritesAndReadsBothEncodings) {
  VesselCase value = threeVessels();
  value.setNote("made by a test");
  const std::string folder = ::testing::TempDir();
  for (const char* name : {"case_library.lumen", "case_library.lumen.json"}) {
    const std::string path = folder + name;
    value.save(path);
    EXPECT_EQ(VesselCase::open(path).encode(), value.encode());
    EXPECT_EQ(VesselCase::open(path).note(), "made by a test");
    std::filesystem::remove(path);
  }
  lumen_case_write_def json = lumen_case_write_def_default();
  json.encoding = LUMEN_CASE_JSON;
  EXPECT_EQ(value.encode(json).front(), '{');
}

TEST(CaseLibrary, RemovesABranchWithAllThatHangOnIt) {
  VesselCase value = threeVessels();
  value.removeBranch(1);
  EXPECT_EQ(value.branchCount(), 1u);
  EXPECT_EQ(value.nodeCount(), 3u);
  EXPECT_EQ(value.findBranch("leaf"), SIZE_MAX);
  EXPECT_STREQ(faultOf([&] { value.removeBranch(0); }).message, "no branch would stay");
}

TEST(CaseLibrary, KeepsPointsModelsAndArraysWithTheirNodes) {
  VesselCase value = threeVessels();
  const std::uint32_t offset[7] = {0, 1, 1, 1, 3, 3, 4};
  const float position[4][3] = {{2, 0, 0}, {2, 1, 2}, {2, -1, 2}, {6, 0.25f, 2}};
  const lumen_case_points points = {4, offset, position};
  ASSERT_EQ(lumen_case_set_points(value.get(), &points, nullptr), LUMEN_CASE_OK);
  const float width[4] = {1, 2, 3, 4};
  const lumen_case_models models = {0, 0.2, 0.1, 4, offset, position, width};
  ASSERT_EQ(lumen_case_set_models(value.get(), &models, nullptr), LUMEN_CASE_OK);
  const std::int32_t grade[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const lumen_case_array array = {"TEST_grade.pair", "", 2, LUMEN_CASE_I32, grade};
  ASSERT_EQ(lumen_case_set_array(value.get(), &array, nullptr), LUMEN_CASE_OK);

  // the leaf goes, then a new vessel of one node takes its place
  value.removeBranch(2);
  value.appendBranch("new", 0, 1, kLeaf, kThinnest);
  ASSERT_EQ(value.points().count, 3u);
  EXPECT_EQ(value.points().offset[4], 3u);
  EXPECT_EQ(value.points().offset[6], 3u);
  EXPECT_EQ(value.models().width[2], 3);
  ASSERT_EQ(value.models().count, 3u);
  const lumen_case_array kept = lumen_case_get_array(value.get(), 0);
  const auto* values = static_cast<const std::int32_t*>(kept.values);
  EXPECT_EQ(std::vector<std::int32_t>(values, values + 12),
            (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0}));

  // the twig lies between: what is behind it moves up
  value.removeBranch(1);
  EXPECT_EQ(value.points().count, 1u);
  EXPECT_EQ(value.nodes().parent[3], 0);
  EXPECT_EQ(value.points().offset[4], 1u);
}

// Nodes 1 and 4 of the three vessels, at 0 s and 1 s.
const double kTimes[2] = {0, 1};
const std::uint32_t kMoving[2] = {1, 4};
const float kPoses[4][8] = {{0, 0, 2, 0, 0, 0, 1, 1},
                            {4, 0, 2, 0, 0, 0, 1, 1},
                            {0, 1, 2, 0, 0, 0.6F, 0.8F, 1},
                            {4, 3, 2, 0, 0, 0, 1, 2}};
const lumen_case_motion kMotion = {2, kTimes, 1.5, 2, kMoving, kPoses};

TEST(CaseLibrary, SetsReadsAndRemovesAMotion) {
  VesselCase value = threeVessels();
  EXPECT_EQ(value.motion().time, nullptr);
  value.setMotion(&kMotion);
  const auto bytes = value.encode();
  const VesselCase read = VesselCase::fromBytes(bytes.data(), bytes.size());
  const lumen_case_motion motion = read.motion();
  ASSERT_EQ(motion.time_count, 2u);
  ASSERT_EQ(motion.node_count, 2u);
  EXPECT_EQ(motion.period, 1.5);
  EXPECT_EQ(motion.time[1], 1);
  EXPECT_EQ(motion.node[1], 4u);
  EXPECT_EQ(std::memcmp(motion.pose, kPoses, sizeof kPoses), 0);
  value.setMotion(nullptr);
  EXPECT_EQ(value.motion().time_count, 0u);
}

TEST(CaseLibrary, GivesThePosesOfAllNodesAtAnyTime) {
  VesselCase value = threeVessels();
  double poses[6][8];
  ASSERT_EQ(lumen_case_poses_at(value.get(), 0.5, 6, poses), LUMEN_CASE_OK);
  EXPECT_EQ(poses[4][0], 4);  // at rest
  value.setMotion(&kMotion);
  ASSERT_EQ(lumen_case_poses_at(value.get(), 0.5, 6, poses), LUMEN_CASE_OK);
  EXPECT_NEAR(poses[4][1], 1.5, 1e-12);
  EXPECT_NEAR(poses[4][7], 1.5, 1e-12);
  EXPECT_NEAR(poses[1][5], std::sin(std::asin(0.6) / 2), 1e-7);
  EXPECT_EQ(poses[0][6], 1);
  EXPECT_EQ(lumen_case_poses_at(value.get(), 0.5, 5, poses), LUMEN_CASE_ERROR_ARGUMENT);
  EXPECT_EQ(lumen_case_poses_at(value.get(), NAN, 6, poses), LUMEN_CASE_ERROR_ARGUMENT);
}

TEST(CaseLibrary, KeepsTheMotionOfNodesThatStayAndDropsItWhereNodesChange) {
  VesselCase value = threeVessels();
  value.setMotion(&kMotion);
  value.removeBranch(1);  // with the leaf
  ASSERT_EQ(value.motion().node_count, 1u);
  EXPECT_EQ(value.motion().pose[1][1], 1);
  value.setNode(0, {0, 0, 0.5F}, 2);
  EXPECT_EQ(value.motion().time_count, 0u);
  value = threeVessels();
  value.setMotion(&kMotion);
  value.appendBranch("more", 5, 1, kLeaf, kThinnest);
  EXPECT_EQ(value.motion().time_count, 0u);
}

TEST(CaseLibrary, RefusesAMotionThatBreaksARule) {
  VesselCase value = threeVessels();
  lumen_case_motion motion = kMotion;
  motion.period = 1;
  EXPECT_STREQ(faultOf([&] { value.setMotion(&motion); }).name, "MOTION_PERIOD");
  motion = kMotion;
  motion.pose = nullptr;
  EXPECT_EQ(lumen_case_set_motion(value.get(), &motion, nullptr), LUMEN_CASE_ERROR_ARGUMENT);
  EXPECT_EQ(value.motion().time_count, 0u);
}

TEST(CaseLibrary, LeavesACaseAsItWasWhenAnEditBreaksARule) {
  VesselCase value = threeVessels();
  const auto before = value.encode();
  const lumen_case_fault twice = faultOf([&] { value.setLabel(1, "trunk"); });
  EXPECT_STREQ(twice.name, "LABEL_DUPLICATE");
  EXPECT_EQ(twice.code, 419);
  const lumen_case_fault radius = faultOf([&] { value.setNode(3, kTwig[0], -1); });
  EXPECT_STREQ(radius.name, "RADIUS_RANGE");
  EXPECT_STREQ(radius.place, "/tree/radius/3");
  EXPECT_STREQ(faultOf([&] { value.appendBranch("x", 77, 1, kLeaf, kThinnest); }).name,
               "NODE_PARENT");
  EXPECT_STREQ(faultOf([&] {
                 value.appendBranch("x", 0, 1, kLeaf, kThinnest, static_cast<lumen_case_kind>(9));
               }).name,
               "ENUM_VALUE");
  EXPECT_EQ(value.encode(), before);
}

TEST(CaseLibrary, SetsAWholeTree) {
  VesselCase value = threeVessels();
  lumen_case_nodes nodes{};
  nodes.count = 3;
  nodes.centre = kTrunk;
  nodes.radius = kWide;
  const float unknown = std::nanf("");
  const lumen_case_stop stop = LUMEN_CASE_STOP_LEFT_VOLUME;
  value.setTree(nodes, {{"a", LUMEN_CASE_VESSEL, -1, 0, 2, stop, 0.5f},
                        {"b", LUMEN_CASE_ANEURYSM, 1, 0, 1, stop, unknown}});
  ASSERT_EQ(value.branchCount(), 2u);
  EXPECT_EQ(value.branch(1).first_node, 2u);
  EXPECT_EQ(value.branch(1).kind, LUMEN_CASE_ANEURYSM);
  EXPECT_EQ(value.branch(0).mean_inlier_rate, 0.5f);
  EXPECT_TRUE(std::isnan(value.branch(1).mean_inlier_rate));
  EXPECT_EQ(value.nodes().parent[2], 1);
  EXPECT_EQ(faultOf([&] {
              value.setTree(nodes, {{"a", LUMEN_CASE_VESSEL, -1, 0, 2, stop, 0}});
            }).code,
            0);
  EXPECT_EQ(value.branchCount(), 2u);
}

TEST(CaseLibrary, ReportsTheRuleThePlaceAndTheFile) {
  auto bytes = threeVessels().encode();
  bytes[bytes.size() / 2] ^= 0x40;
  const lumen_case_fault fault =
      faultOf([&] { (void)VesselCase::fromBytes(bytes.data(), bytes.size()); });
  EXPECT_GT(fault.code, 100);
  EXPECT_EQ(std::string(fault.place).substr(0, 5), "byte ");
  lumen_case_counts counts;
  std::vector<std::string> names;
  const auto receive = [](const lumen_case_fault* received, void* user) {
    static_cast<std::vector<std::string>*>(user)->push_back(received->name);
  };
  EXPECT_EQ(lumen_case_validate_bytes(bytes.data(), bytes.size(), 10, receive, &names, &counts),
            LUMEN_CASE_ERROR_RULE);
  EXPECT_EQ(names.size(), counts.errors + counts.warnings + counts.information);
  EXPECT_EQ(names.front(), fault.name);
  const lumen_case_fault missing = faultOf([] { (void)VesselCase::open("/no/such.lumen"); });
  EXPECT_STREQ(missing.name, "IO_MISSING");
  EXPECT_NE(std::strstr(missing.message, "/no/such.lumen"), nullptr);
}

TEST(CaseLibrary, CutsLongTextsOffAtAWholeCharacter) {
  std::string path = "/";
  for (int i = 0; i < 400; ++i) path += "\xc3\xa9";  // of two bytes each
  lumen_case* value = nullptr;
  lumen_case_fault fault;
  EXPECT_EQ(lumen_case_open(path.c_str(), &value, &fault), LUMEN_CASE_ERROR_FILE);
  EXPECT_EQ(value, nullptr);
  const std::size_t size = std::strlen(fault.message);
  ASSERT_GE(size, sizeof fault.message - 2);
  EXPECT_NE(static_cast<unsigned char>(fault.message[size - 1]), 0xc3);
}

TEST(CaseLibrary, RefusesNullPointersAndAnEmptyCase) {
  lumen_case_fault fault;
  EXPECT_EQ(lumen_case_open(nullptr, nullptr, &fault), LUMEN_CASE_ERROR_ARGUMENT);
  EXPECT_EQ(lumen_case_save(nullptr, "x", nullptr, &fault), LUMEN_CASE_ERROR_ARGUMENT);
  EXPECT_EQ(lumen_case_get_nodes(nullptr).count, 0u);
  EXPECT_EQ(lumen_case_get_branch(threeVessels().get(), 3).label, nullptr);
  EXPECT_STREQ(faultOf([] { (void)VesselCase().encode(); }).name, "TREE_EMPTY");
  lumen_case_write_def def{};
  EXPECT_EQ(lumen_case_save(threeVessels().get(), "x", &def, &fault), LUMEN_CASE_ERROR_ARGUMENT);
}

}  // namespace
