// SPDX-License-Identifier: Apache-2.0
// lumen's own seeds format.
#include "converters/io/seeds/seeds.h"

#include <gtest/gtest.h>

#include "fixtures.h"
#include "tests/unit/formats/json_samples.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::BranchKind;

class Seeds : public FileTest {
protected:
  /// A seeds file with these branches (JSON), LPS and mm.
  std::filesystem::path file(const std::string& branches, const std::string& frame = "LPS",
                             const std::string& units = "mm") const {
    return write("s.json", R"({"format": "lumen-seeds", "version": 1, "coordinateSystem": ")" +
                               frame + R"(", "units": ")" + units + R"(", "branches": [)" +
                               branches + "]}");
  }
  [[nodiscard]] std::vector<SeedBranch> read(const std::string& branches) const {
    return readSeeds(file(branches));
  }
  void expectBranchesRefused(const std::string& branches, std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "s.json"});
    expectRefused(refusal([&] { (void)read(branches); }), words);
  }
  void expectFileRefused(const std::string& text, std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "s.json"});
    expectRefused(refusal([&] { (void)readSeeds(write("s.json", text)); }), words);
  }
  [[nodiscard]] std::string labels(const std::string& branches) const {
    std::string all;
    for (const auto& branch : read(branches)) all += branch.label + " ";
    return all;
  }
};

std::string one(const std::string& label, const std::string& parent = "") {
  return R"({"label": ")" + label + R"(", "points": [[1, 2, 3]])" +
         (parent.empty() ? "" : R"(, "parent": ")" + parent + "\"") + "}";
}

TEST_F(Seeds, NumbersOfEveryWriterAreTheNearestDouble) {
  const auto samples = lumen::test::jsonSamples(1e6);
  std::string branches;
  for (const auto& sample : samples)
    branches += (branches.empty() ? "" : ",") + std::string(R"({"label": "b)") +
                std::to_string(&sample - samples.data()) + R"(", "points": [[)" + sample.text +
                ", 0, 0]]}";
  const auto seeds = read(branches);
  ASSERT_EQ(seeds.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    EXPECT_EQ(seeds[i].points[0].position.x(), samples[i].value) << samples[i].text;
}

TEST_F(Seeds, NumbersBeyondADoubleAreShownAsTheyAreWritten) {
  expectBranchesRefused(R"({"label": "a", "points": [[1, 1e400, 3]]})",
                        {"/branches/0/points/0/1", "found 1e400; expected a number"});
}

TEST_F(Seeds, SmallestFileGivesAVesselFromOnePoint) {
  const auto seeds = read(R"({"label": "ICA", "points": [[1.5, -2, 3]]})");
  ASSERT_EQ(seeds.size(), 1U);
  EXPECT_EQ(seeds[0].label, "ICA");
  EXPECT_EQ(seeds[0].kind, BranchKind::Vessel);
  EXPECT_FALSE(seeds[0].parent);
  EXPECT_FALSE(seeds[0].direction);
  ASSERT_EQ(seeds[0].points.size(), 1U);
  EXPECT_EQ(seeds[0].points[0].position, Vector3d(1.5, -2, 3));
  EXPECT_FALSE(seeds[0].points[0].radius);
}

TEST_F(Seeds, ExampleOfTheSpecificationIsRead) {
  const std::string text = bytesOf(LUMEN_TEST_DATA "/../../spec/seeds.md");
  const auto begin = text.find("```json\n") + 8;
  const auto seeds =
      readSeeds(write("s.json", text.substr(begin, text.find("```", begin) - begin)));
  ASSERT_EQ(seeds.size(), 3U);
  EXPECT_EQ(seeds[2].label, "sac");
  EXPECT_EQ(seeds[2].points[1].radius, 3.1);
}

TEST_F(Seeds, EveryKeyIsRead) {
  const auto seeds =
      readSeeds(write("s.json", R"({"$schema": "seeds.schema.json", "format": "lumen-seeds",
      "version": 1, "comment": "synthetic", "coordinateSystem": "LPS", "units": "mm", "branches": [
      {"label": "ICA", "points": [[0, 0, 0]]},
      {"label": "sac", "kind": "aneurysm", "parent": "ICA", "comment": "dome", "direction": [0, 3, 4],
       "points": [{"position": [1, 2, 3], "radius": 2.5}, {"position": [1, 2, 5], "radius": 3}]}]})"));
  ASSERT_EQ(seeds.size(), 2U);
  EXPECT_EQ(seeds[1].kind, BranchKind::Aneurysm);
  EXPECT_EQ(seeds[1].parent, "ICA");
  EXPECT_LT((*seeds[1].direction - Vector3d(0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_EQ(seeds[1].points[1].position, Vector3d(1, 2, 5));
  EXPECT_EQ(seeds[1].points[1].radius, 3);
}

TEST_F(Seeds, RasIsTurnedIntoLps) {
  const auto seeds =
      readSeeds(file(R"({"label": "a", "points": [[1, 2, 3]], "direction": [1, 0, 0]})", "RAS"));
  EXPECT_EQ(seeds[0].points[0].position, Vector3d(-1, -2, 3));
  EXPECT_EQ(*seeds[0].direction, Vector3d(-1, 0, 0));
}

TEST_F(Seeds, MetresBecomeMillimetres) {
  const auto seeds = readSeeds(file(
      R"({"label": "a", "points": [[0.001, 0, 0.25]], "radius": 0.002, "direction": [0, 0, 2]})",
      "LPS", "m"));
  EXPECT_LT((seeds[0].points[0].position - Vector3d(1, 0, 250)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(*seeds[0].points[0].radius, 2);
  EXPECT_EQ(*seeds[0].direction, Vector3d(0, 0, 1));
}

TEST_F(Seeds, RadiusOfAVesselIsThatOfItsFirstPoint) {
  const auto seeds = read(R"({"label": "a", "points": [[0, 0, 0], [1, 0, 0]], "radius": 2})");
  EXPECT_EQ(seeds[0].points[0].radius, 2);
  EXPECT_FALSE(seeds[0].points[1].radius);
}

TEST_F(Seeds, RadiusOfAnAneurysmIsThatOfThePointsWithoutOne) {
  const auto seeds = read(R"({"label": "a", "kind": "aneurysm", "radius": 2,
      "points": [[0, 0, 0], {"position": [1, 0, 0], "radius": 3}, [2, 0, 0]]})");
  EXPECT_EQ(seeds[0].points[0].radius, 2);
  EXPECT_EQ(seeds[0].points[1].radius, 3);
  EXPECT_EQ(seeds[0].points[2].radius, 2);
}

TEST_F(Seeds, ParentsComeFirstOtherwiseInFileOrder) {
  EXPECT_EQ(labels(one("d", "c") + "," + one("a") + "," + one("c", "b") + "," + one("e") + "," +
                   one("b")),
            "b c d a e ");
}

TEST_F(Seeds, UnknownParentIsRefused) {
  expectBranchesRefused(one("a") + "," + one("b", "x"), {"\"b\"", "parent \"x\" is unknown"});
}

TEST_F(Seeds, CycleIsRefused) {
  expectBranchesRefused(one("r") + "," + one("a", "c") + "," + one("b", "a") + "," + one("c", "b"),
                        {"\"a\" -> \"c\" -> \"b\" -> \"a\"", "cycle"});
  expectBranchesRefused(one("a", "a"), {"\"a\" -> \"a\""});
}

TEST_F(Seeds, DuplicateLabelIsRefused) {
  expectBranchesRefused(one("a") + "," + one("b") + "," + one("a"),
                        {"\"a\"", "branches number 1 and 3"});
}

TEST_F(Seeds, LabelFollowsTheRulesOfACase) {
  expectBranchesRefused(one(""), {"branch number 1", "label \"\" is empty"});
  expectBranchesRefused(one("a") + "," + one("b\\u0007"), {"branch number 2", "label"});
  expectBranchesRefused(one(std::string(256, 'x')), {"branch number 1", "label"});
}

TEST_F(Seeds, RadiusThatIsNotPositiveIsRefused) {
  for (const char* bad : {"0", "-1", "-1e-9"}) {
    expectBranchesRefused(
        R"({"label": "a", "points": [[0, 0, 0]], "radius": )" + std::string(bad) + "}",
        {"\"a\"", "point 1", "radius", "positive"});
    expectBranchesRefused(
        R"({"label": "a", "points": [[0, 0, 0], {"position": [1, 0, 0], "radius": )" +
            std::string(bad) + "}]}",
        {"\"a\"", "point 2", "radius", "positive"});
  }
}

TEST_F(Seeds, NumberBeyondADoubleIsRefused) {
  expectBranchesRefused(R"({"label": "a", "points": [[1e999, 0, 0]]})", {});
}

TEST_F(Seeds, BranchWithoutPointsIsRefused) {
  expectBranchesRefused(R"({"label": "a", "points": []})", {"\"a\"", "no points"});
}

TEST_F(Seeds, PointTwiceInARowIsOne) {
  const auto seeds =
      read(R"({"label": "a", "points": [[1, 2, 3], {"position": [1, 2, 3], "radius": 2},
      [1, 2, 3], [1, 2, 4], [1, 2, 3]]})");
  ASSERT_EQ(seeds[0].points.size(), 3U);
  EXPECT_EQ(seeds[0].points[0].radius, 2);
  EXPECT_EQ(seeds[0].points[2].position, Vector3d(1, 2, 3));
}

TEST_F(Seeds, ZeroDirectionIsRefused) {
  expectBranchesRefused(R"({"label": "a", "points": [[1, 2, 3]], "direction": [0, 0, 0]})",
                        {"\"a\"", "direction", "not zero"});
}

TEST_F(Seeds, UnknownKindIsRefused) {
  expectBranchesRefused(R"({"label": "a", "points": [[1, 2, 3]], "kind": "vein"})",
                        {"\"a\"", "/branches/0/kind", "\"vein\"", "aneurysm"});
}

TEST_F(Seeds, AneurysmPointWithoutARadiusIsRefused) {
  expectBranchesRefused(
      R"({"label": "a", "kind": "aneurysm", "points": [{"position": [0, 0, 0], "radius": 1}, [1, 0, 0]]})",
      {"\"a\"", "point 2", "no radius"});
}

TEST_F(Seeds, UnknownKeyIsRefusedWithItsPlace) {
  expectBranchesRefused(R"({"label": "a", "points": [[1, 2, 3]], "lable": "b"})",
                        {"/branches/0/lable", "unknown key"});
  expectBranchesRefused(R"({"label": "a", "points": [{"position": [1, 2, 3], "r/d~": 1}]})",
                        {"/branches/0/points/0/r~1d~0", "position, radius"});
}

TEST_F(Seeds, MissingKeyIsRefused) {
  expectBranchesRefused(R"({"points": [[1, 2, 3]]})", {"/branches/0", "\"label\" is missing"});
  expectBranchesRefused(R"({"label": "a"})", {"\"points\" is missing"});
  expectFileRefused(R"({"format": "lumen-seeds", "version": 1, "units": "mm", "branches": []})",
                    {"\"coordinateSystem\" is missing"});
}

TEST_F(Seeds, WrongTypesAreRefusedWithTheirPlace) {
  expectBranchesRefused(R"({"label": 5, "points": [[1, 2, 3]]})",
                        {"/branches/0/label", "found 5", "a string"});
  expectBranchesRefused(R"({"label": "a", "points": [[1, 2]]})",
                        {"/branches/0/points/0", "three numbers"});
  expectBranchesRefused(R"({"label": "a", "points": [[1, 2, "3"]]})",
                        {"/branches/0/points/0/2", "a number"});
  expectBranchesRefused(R"({"label": "a", "points": [1, 2, 3]})",
                        {"/branches/0/points/0", "[x, y, z]"});
  expectBranchesRefused(R"({"label": "a", "points": {}})", {"/branches/0/points", "an array"});
  expectBranchesRefused("7", {"/branches/0", "an object"});
}

TEST_F(Seeds, FrameUnitsFormatAndVersionAreChecked) {
  expectRefused(refusal([&] { (void)readSeeds(file(one("a"), "LAS")); }),
                {"/coordinateSystem", "\"LAS\"", "RAS"});
  expectRefused(refusal([&] { (void)readSeeds(file(one("a"), "LPS", "cm")); }),
                {"/units", "\"cm\"", "mm"});
  expectFileRefused(R"({"format": "seeds"})", {"/format", "lumen-seeds"});
  expectFileRefused(R"({"format": "lumen-seeds", "version": 2})", {"/version", "found 2"});
}

TEST_F(Seeds, FileWithoutBranchesIsRefused) {
  expectBranchesRefused("", {"no seeds"});
}

TEST_F(Seeds, KeyTwiceInOneObjectIsRefused) {
  expectBranchesRefused(R"({"label": "a", "label": "b", "points": [[1, 2, 3]]})",
                        {"\"label\"", "twice"});
}

TEST_F(Seeds, WhatIsNotJsonIsRefused) {
  expectFileRefused("", {"not JSON"});
  expectFileRefused("{\"format\": ", {"not JSON"});
  expectFileRefused("\"a\xff\"", {"not JSON"});
  expectFileRefused("[]", {"an object"});
  expectFileRefused(std::string(100000, '['), {"nested deeper"});
}

TEST_F(Seeds, MissingFileIsRefused) {
  expectRefused(refusal([&] { (void)readSeeds(path("absent.json")); }), {"3: ", "absent.json"});
}

TEST_F(Seeds, WrittenSeedsAreReadBackExactly) {
  SeedBranch ica{"ICA \"left\"",
                 BranchKind::Vessel,
                 {},
                 {{{0.1, -2e-7, 1.0 / 3}, 2.125}, {{1, 2, 3}, {}}},
                 Vector3d(0.6, 0, 0.8)};
  SeedBranch sac{"sac", BranchKind::Aneurysm, "ICA \"left\"", {{{7, 8, 9}, 0.1}}, {}};
  writeSeeds({ica, sac}, path("out.json"));
  const auto seeds = readSeeds(path("out.json"));
  ASSERT_EQ(seeds.size(), 2U);
  EXPECT_EQ(seeds[0].label, ica.label);
  EXPECT_EQ(seeds[0].points[0].position, ica.points[0].position);
  EXPECT_EQ(seeds[0].points[0].radius, 2.125);
  EXPECT_FALSE(seeds[0].points[1].radius);
  EXPECT_LT((*seeds[0].direction - *ica.direction).norm(), 1e-15);
  EXPECT_EQ(seeds[1].kind, BranchKind::Aneurysm);
  EXPECT_EQ(seeds[1].parent, ica.label);
}

TEST_F(Seeds, OptionsStateTheFrameOfCoordinatesWhateverTheFileStates) {
  const auto seeds = readSeeds(file(R"({"label": "a", "points": [[1, 2, 3]], "radius": 2})"),
                               {SeedSystem::Ras, 1000.0});
  EXPECT_EQ(seeds[0].points[0].position, Vector3d(-1000, -2000, 3000));
  EXPECT_EQ(seeds[0].points[0].radius, 2000);
  const auto voxels =
      readSeeds(file(R"({"label": "a", "points": [[1, 2, 3]], "radius": 2})", "RAS"),
                {SeedSystem::Voxel, {}});
  EXPECT_EQ(voxels[0].points[0].position, Vector3d(1, 2, 3));
  EXPECT_EQ(voxels[0].points[0].radius, 2);
  EXPECT_EQ(readSeeds(file(one("a"), "LPS", "cm"), {{}, 10.0})[0].points[0].position,
            Vector3d(10, 20, 30));
}

TEST_F(Seeds, ACaseHoldsNoMoreBranchesThanItMay) {
  std::string branches;
  for (int i = 0; i < 65536; ++i) branches.append(i == 0 ? "" : ",").append(one(std::to_string(i)));
  expectBranchesRefused(branches, {"65536 seeds", "at most 65535"});
}

TEST_F(Seeds, TextsOfTheFileAreEscaped) {
  const std::string evil = R"(\u001b[2J\nlumen: valid\u202e)";  // as JSON writes it
  for (const std::string& branches :
       {one(evil), one("a", evil), one("a") + R"(, {")" + evil + R"(": 1})",
        R"({"label": "a", "kind": ")" + evil + R"(", "points": [[1, 2, 3]]})"}) {
    const std::string message = refusal([&] { (void)read(branches); });
    for (const char* raw : {"\x1b", "\n", "\xe2\x80\xae"})
      EXPECT_EQ(message.find(raw), std::string::npos) << message;
    EXPECT_NE(message.find("\\u001b"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace lumen::convert
