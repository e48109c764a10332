// SPDX-License-Identifier: Apache-2.0
// validate, info --chunks, what a conversion loses, and the options of the case file.
#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

/// Two nodes with a model, four wall points and a note.
formats::Case sample() {
  formats::Case value;
  auto& tree = value.tree;
  tree.centre = {{0, 0, 0}, {0, 0, 1}};
  tree.direction = {{0, 0, 1}, {0, 0, 1}};
  tree.radius = {1, 1};
  tree.height = {1, 1};
  tree.parent = {-1, 0};
  tree.branch = {0, 0};
  formats::Branch branch;
  branch.label = "tube";
  branch.nodeCount = 2;
  tree.branches = {branch};
  value.points = formats::PointSets{
      {0, 2, 4}, {{1, 0.1234567f, 0}, {-1, 0, 0}, {0, 1, 1.7654321f}, {0, -1, 1}}};
  value.models = formats::BlobbyModels{formats::Kernel::Cauchy, 0.2,         0.1, {0, 1, 2},
                                       {{0, 0, 0}, {0, 0, 1}},  {0.5f, 0.5f}};
  value.metadata.note = "synthetic";
  value.metadata.voxelSize = 0.5;
  return value;
}

}  // namespace

class ValidateTest : public CliTest {
protected:
  void SetUp() override { put("good.lumen", sample()); }
  void put(const std::string& name, const formats::Case& value) const {
    ASSERT_TRUE(formats::writeCaseFile(value, path(name)));
  }
  /// The good file with a byte of its points changed.
  void damage() const {
    std::string bytes = read("good.lumen");
    bytes[bytes.find("synthetic")] = 'S';
    write("bad.lumen", bytes);
  }
};

TEST_F(ValidateTest, AValidFileExitsWithZeroAndSaysSo) {
  const Outcome valid = lumen({"validate", "good.lumen"});
  EXPECT_EQ(valid.code, 0) << valid.err;
  EXPECT_EQ(valid.out, "good.lumen: valid\n");
}

TEST_F(ValidateTest, AFaultExitsWithThreeAndHasItsCodeAndPlace) {
  damage();
  const Outcome refused = lumen({"validate", "good.lumen", "bad.lumen"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.out, "good.lumen: valid\n")) << refused.out;
  EXPECT_TRUE(contains(refused.out, "bad.lumen: error CHUNK_CHECKSUM at byte ")) << refused.out;
  EXPECT_TRUE(contains(refused.out, "bad.lumen: not valid\n")) << refused.out;
}

TEST_F(ValidateTest, JsonHasEveryFieldOfAnIssue) {
  damage();
  const Outcome refused = lumen({"validate", "bad.lumen", "gone.lumen", "--json"});
  EXPECT_EQ(refused.code, 3);
  const Json report = Json::parse(refused.out);
  EXPECT_EQ(report["valid"], false);
  ASSERT_EQ(report["files"].size(), 2U);
  const Json issue = report["files"][0]["issues"][0];
  EXPECT_EQ(issue["code"], "CHUNK_CHECKSUM");
  EXPECT_EQ(issue["number"], 114);
  EXPECT_EQ(issue["severity"], "error");
  EXPECT_TRUE(issue["offset"].is_number());
  EXPECT_TRUE(issue["pointer"].is_null());
  EXPECT_EQ(issue["arguments"]["chunk"], "META");
  EXPECT_EQ(report["files"][1]["issues"][0]["code"], "IO_MISSING");
}

TEST_F(ValidateTest, MaxIssuesStopsAndSaysThatThereMayBeMore) {
  std::string text = formats::encodeJson(sample());
  text.replace(text.find("\"radius\": [1, 1]"), 16, "\"radius\": [0, 0]");
  write("bad.lumen.json", text);
  const Json all = Json::parse(lumen({"validate", "bad.lumen.json", "--json"}).out);
  EXPECT_EQ(all["files"][0]["issues"].size(), 2U);
  EXPECT_EQ(all["files"][0]["complete"], true);
  const Json one =
      Json::parse(lumen({"validate", "bad.lumen.json", "--json", "--max-issues", "1"}).out);
  EXPECT_EQ(one["files"][0]["issues"].size(), 1U);
  EXPECT_EQ(one["files"][0]["complete"], false);
}

TEST_F(ValidateTest, AWarningFailsOnlyWhenStrict) {
  std::string text = formats::encodeJson(sample());
  const std::size_t number = text.find('0', text.find("\"centre\""));
  text.replace(number, 1, "-0.0");
  write("a.lumen.json", text);
  const Outcome lenient = lumen({"validate", "a.lumen.json"});
  EXPECT_EQ(lenient.code, 0) << lenient.out;
  EXPECT_TRUE(contains(lenient.out, "warning NEGATIVE_ZERO")) << lenient.out;
  EXPECT_EQ(lumen({"validate", "a.lumen.json", "--strict"}).code, 3);
  EXPECT_EQ(lumen({"validate", "good.lumen", "--strict"}).code, 0);
}

TEST_F(ValidateTest, PrivacyLooksAtTextsOnlyWhenAskedTo) {
  formats::Case value = sample();
  value.metadata.note = "scanned on 2014-03-21";
  put("dated.lumen", value);
  EXPECT_EQ(lumen({"validate", "dated.lumen"}).code, 0);
  const Outcome found = lumen({"validate", "dated.lumen", "--privacy"});
  EXPECT_EQ(found.code, 3);
  EXPECT_TRUE(contains(found.out, "dated.lumen: warning PRIVACY_DATE")) << found.out;
  EXPECT_TRUE(contains(found.out, "/metadata/note")) << found.out;
}

TEST_F(ValidateTest, ChunksAreListedWithTheirPlacesAndSizes) {
  const Json info = Json::parse(lumen({"info", "good.lumen", "--chunks", "--json"}).out);
  EXPECT_EQ(info["version"], "1.1");
  EXPECT_EQ(info["length"], std::filesystem::file_size(path("good.lumen")));
  ASSERT_EQ(info["chunks"].size(), 15U);
  EXPECT_EQ(info["chunks"][0]["type"], "META");
  EXPECT_EQ(info["chunks"][0]["offset"], 64 + 15 * 64);
  EXPECT_EQ(info["chunks"][1]["stored"], 24);
  EXPECT_EQ(info["chunks"][1]["encoding"], "raw");
  EXPECT_EQ(info["chunks"][1]["intact"], true);
  const std::string text = lumen({"info", "good.lumen", "--chunks"}).out;
  EXPECT_TRUE(contains(text, "\nNCEN")) << text;
}

TEST_F(ValidateTest, ADamagedChunkIsMarkedInTheList) {
  damage();
  const Outcome listed = lumen({"info", "bad.lumen", "--chunks"});
  EXPECT_EQ(listed.code, 0);
  EXPECT_TRUE(contains(listed.out, "DAMAGED")) << listed.out;
}

TEST_F(ValidateTest, JsonHasNoChunksToList) {
  put("good.lumen.json", sample());
  EXPECT_EQ(lumen({"info", "good.lumen.json", "--chunks"}).code, 4);
}

TEST_F(ValidateTest, ThereAndBackGivesTheSameBytes) {
  ASSERT_EQ(lumen({"convert", "good.lumen", "b.lumen.json"}).code, 0);
  ASSERT_EQ(lumen({"convert", "b.lumen.json", "c.lumen"}).code, 0);
  EXPECT_EQ(read("good.lumen"), read("c.lumen"));
}

TEST_F(ValidateTest, ACompressedFileHoldsTheSame) {
  formats::Case value = sample();
  for (int i = 0; i < 500; ++i) value.points->position.push_back({1, 1, 1});
  value.points->offset.back() += 500;
  put("good.lumen", value);
  ASSERT_EQ(lumen({"convert", "good.lumen", "small.lumen", "--compress"}).code, 0);
  EXPECT_LT(std::filesystem::file_size(path("small.lumen")),
            std::filesystem::file_size(path("good.lumen")) / 2);
  ASSERT_EQ(lumen({"convert", "small.lumen", "back.lumen"}).code, 0);
  EXPECT_EQ(read("good.lumen"), read("back.lumen"));
}

TEST_F(ValidateTest, RoundedPointsAreStatedAndNameTheirParent) {
  for (const char* name : {"r.lumen", "r.lumen.json"}) {
    ASSERT_EQ(lumen({"convert", "good.lumen", name, "--point-bits", "10"}).code, 0);
    const auto rounded = formats::readCaseFile(path(name));
    ASSERT_TRUE(rounded);
    ASSERT_TRUE(rounded->metadata.pointQuantisation);
    EXPECT_EQ(rounded->metadata.pointQuantisation->bits, 10);
    EXPECT_NEAR(rounded->metadata.pointQuantisation->step, 2.0 / 1023, 1e-9);
    EXPECT_EQ(rounded->metadata.parentSha256.size(), 64U);
    EXPECT_NE(rounded->points->position, sample().points->position);
    EXPECT_EQ(rounded->models, sample().models);
  }
}

TEST_F(ValidateTest, WhatNoMeshHoldsIsSaidInTheHelpAndIsNoWarning) {
  EXPECT_TRUE(contains(lumen({"convert", "--help"}).out, "mesh, which holds the surface"));
  for (const auto& arguments : {std::vector<std::string>{}, {"--strict"}}) {
    std::vector<std::string> command = {"convert", "good.lumen", "a.stl"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Outcome converted = lumen(command);
    EXPECT_EQ(converted.code, 0) << converted.err;
    EXPECT_FALSE(contains(converted.err, "lumen: ")) << converted.err;
  }
}

TEST_F(ValidateTest, BranchesThatAMeshLacksAreNamedWithACellThatKeepsThem) {
  const Outcome converted = lumen({"convert", "good.lumen", "a.stl", "--patches", "--cell", "50"});
  EXPECT_EQ(converted.code, 0);
  for (const char* part : {"a.stl", "\"tube\" has ", "50 mm", "--cell"})
    EXPECT_TRUE(contains(converted.err, part)) << converted.err;
  const Outcome refused =
      lumen({"convert", "good.lumen", "b.stl", "--patches", "--cell", "50", "--strict"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_FALSE(exists("b.stl"));
}

TEST_F(ValidateTest, SeedsThatCannotBeReadAreAWarningAndTheCaseIsLegalAllTheSame) {
  formats::Case value = sample();
  value.otherChunks = {{"SEED", 1, true, 0, 2, {std::byte{'{'}, std::byte{'}'}}}};
  put("good.lumen", value);
  const Outcome checked = lumen({"validate", "good.lumen"});
  EXPECT_EQ(checked.code, 0);
  EXPECT_TRUE(contains(checked.out, "warning SEEDS at file: the case: its seeds")) << checked.out;
  EXPECT_FALSE(contains(checked.out, "CHUNK_IGNORED")) << checked.out;
  EXPECT_EQ(lumen({"validate", "good.lumen", "--strict"}).code, 3);
  const Outcome info = lumen({"info", "good.lumen", "--json"});
  EXPECT_EQ(info.code, 0);
  EXPECT_EQ(Json::parse(info.out)["seeds"], nullptr);
}

TEST_F(ValidateTest, ChunksOfOthersSurviveAConversion) {
  formats::Case value = sample();
  value.otherChunks = {{"acme", 1, false, 0, 2, {std::byte{1}, std::byte{2}}}};
  put("good.lumen", value);
  ASSERT_EQ(lumen({"convert", "good.lumen", "a.lumen.json"}).code, 0);
  ASSERT_EQ(lumen({"convert", "a.lumen.json", "b.lumen"}).code, 0);
  EXPECT_EQ(read("good.lumen"), read("b.lumen"));
}

}  // namespace lumen::test
