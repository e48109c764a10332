// SPDX-License-Identifier: Apache-2.0
// Profiles, and verdicts on reports that are made by hand.
#include "converters/judge/gate/gate.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::convert {

namespace {

/// Two branches of five nodes each, along x at y = 0 and y = 10.
formats::Case twoBranches() {
  formats::Case value;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const bool isSecond = i >= 5;
    value.tree.centre.push_back({static_cast<float>(i % 5), isSecond ? 10.0F : 0.0F, 0});
    value.tree.branch.push_back(isSecond ? 1 : 0);
  }
  value.tree.branches.resize(2);
  value.tree.branches[0].label = "a";
  value.tree.branches[1].label = "b";
  return value;
}

/// A report without a fault.
CheckReport goodReport() {
  CheckReport report;
  report.voxelSize = 0.5;
  report.offsets.absoluteMedian = 0.1;
  report.offsets.absoluteP90 = 0.2;
  report.lumenVolume = 1000;
  report.shownLength = 100;
  report.nodes.assign(10, Agreement::Good);
  return report;
}

const Reach kAllReached{100, 100, 1, 1, 100, {}};

GateVerdict judged(const std::string& profile, const CheckReport& report,
                   const std::optional<Reach>& reach = kAllReached) {
  return judgeCase(gateProfile(profile), twoBranches(), report, reach);
}

MissingVessel missing(double length) {
  MissingVessel vessel;
  vessel.path = {{{1, 1, 0}, 1}, {{1, 5, 0}, 1}, {{1, 9, 0}, 1}};
  vessel.length = length;
  return vessel;
}

std::string refusal(const std::string& text) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "profile.json";
  std::ofstream(file) << text;
  try {
    (void)gateProfile(file.string());
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput) << text;
    return error.what();
  }
  return "taken";
}

}  // namespace

TEST(Gate, AGoodCasePassesEveryProfile) {
  for (const GateProfile& profile : gateProfiles()) {
    const GateVerdict verdict = judged(profile.name, goodReport());
    EXPECT_TRUE(verdict.passes()) << profile.name;
    EXPECT_FALSE(verdict.worst) << profile.name;
    EXPECT_EQ(verdict.profile, profile.name);
  }
}

TEST(Gate, ALimitIsKeptAtTheLimit) {
  CheckReport report = goodReport();
  report.missing.vessels = {missing(25)};  // 100 of 125 mm: 0.8
  EXPECT_TRUE(judged("screening", report).passes());
  report.missing.vessels = {missing(26)};
  const GateVerdict verdict = judged("screening", report);
  ASSERT_EQ(verdict.faults.size(), 1U);
  EXPECT_EQ(verdict.faults[0].threshold.measure, "coverage_share");
  EXPECT_NEAR(verdict.faults[0].found, 100.0 / 126, 1e-12);
}

TEST(Gate, TheWorstPlaceOfAMissingVesselIsItsMiddle) {
  CheckReport report = goodReport();
  report.missing.vessels = {missing(60)};
  const GateVerdict verdict = judged("simulator", report);
  ASSERT_TRUE(verdict.worst);
  EXPECT_EQ(verdict.worst->position, Eigen::Vector3d(1, 5, 0));
  EXPECT_EQ(verdict.worst->node, 1U);
}

TEST(Gate, TheWorstPlaceOfAWallIsTheMiddleOfTheLongestPoorRun) {
  CheckReport report = goodReport();
  report.offsets.absoluteMedian = 2;
  // nodes 4 and 5 belong to two branches: the longest run is 5, 6, 7
  for (const std::size_t i : {1U, 3U, 4U, 5U, 6U, 7U}) report.nodes[i] = Agreement::Poor;
  const GateVerdict verdict = judged("screening", report);
  ASSERT_TRUE(verdict.worst);
  EXPECT_EQ(verdict.worst->node, 6U);
  EXPECT_EQ(verdict.worst->position, Eigen::Vector3d(1, 10, 0));
}

TEST(Gate, TheFaultFarthestBeyondItsLimitComesFirst) {
  CheckReport report = goodReport();
  report.dark.volume = 60;  // 0.06, a fifth beyond 0.05
  report.dark.regions.resize(1);
  report.dark.regions[0].position = {7, 7, 7};
  report.missing.vessels = {missing(100)};  // 0.5: 0.3 beyond, of 0.2
  const GateVerdict verdict = judged("screening", report);
  ASSERT_EQ(verdict.faults.size(), 2U);
  EXPECT_EQ(verdict.faults[0].threshold.measure, "coverage_share");
  EXPECT_EQ(verdict.faults[1].threshold.measure, "dark_share");
  EXPECT_NEAR(verdict.faults[1].excess, 0.2, 1e-9);
}

TEST(Gate, AMeasureThatIsNotKnownDoesNotPass) {
  CheckReport report = goodReport();
  report.offsets.absoluteMedian = NAN;
  const GateVerdict verdict = judged("screening", report);
  ASSERT_EQ(verdict.faults.size(), 1U);
  EXPECT_TRUE(std::isnan(verdict.faults[0].found));
  EXPECT_FALSE(judged("screening", goodReport(), std::nullopt).passes());
}

TEST(Gate, AClosedPathIsThePlaceOfWhatIsNotReached) {
  Reach reach{10, 100, 1, 1, 100, {}};
  reach.closed.push_back({"b", 7, {}, 90});
  const GateVerdict verdict = judged("flow", goodReport(), reach);
  ASSERT_TRUE(verdict.worst);
  EXPECT_EQ(verdict.worst->node, 7U);
}

TEST(GateProfile, IsReadFromAFile) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "ours.json";
  std::ofstream(file)
      << R"({"name": "ours", "least": {"coverage_share": 0.5}, "most": {"nodes_outside": 0}})";
  const GateProfile profile = gateProfile(file.string());
  EXPECT_EQ(profile.name, "ours");
  ASSERT_EQ(profile.thresholds.size(), 2U);
  EXPECT_TRUE(profile.thresholds[0].isLeast);
  EXPECT_EQ(profile.thresholds[1].measure, "nodes_outside");
  CheckReport report = goodReport();
  report.nodesOutside = 1;
  EXPECT_EQ(judged(file.string(), report).faults.size(), 1U);
}

TEST(GateProfile, IsRefusedWithTheReason) {
  EXPECT_NE(refusal(R"({"name": "x", "most": {"darkness": 1}})").find("coverage_share, missing_mm"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"name": "x", "most": {"coverage_share": 1}})").find("below \"least\""),
            std::string::npos);
  EXPECT_NE(refusal(R"({"name": "x", "most": {"dark_share": -1}})").find("a number from 0"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"name": "x"})").find("a threshold"), std::string::npos);
  EXPECT_NE(refusal(R"({"name": "", "most": {"dark_share": 1}})").find("1 to 100 bytes"),
            std::string::npos);
  EXPECT_NE(refusal("no").find("profile.json"), std::string::npos);
  EXPECT_THROW((void)gateProfile("simulater"), Error);
  EXPECT_THROW((void)gateProfile("none.json"), Error);
}

}  // namespace lumen::convert
