// SPDX-License-Identifier: Apache-2.0
#include "converters/export/export_case.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/progress.h"

namespace lumen::convert {

namespace {

/// A target that writes what it was given.
ExportResult echo(const ExportInput& input, const ExportOptions& /*options*/) {
  ExportResult result;
  result.files = {{"place.txt", std::string(unitName(input.frame.unit)), "a unit", "cm"}};
  result.ends = {{"in|let", FaceKind::Inlet, {10, 20, 30}, {0, 0, 1}, 2}};
  result.start = "Open it.\n";
  result.losses = {"nothing is | lost"};
  return result;
}

ExportTarget target() {
  return {{.name = "echo",
           .title = "Echo",
           .files = {},
           .units = {LengthUnit::Metre, LengthUnit::Centimetre},
           .axes = {Axes::Lsa},
           .holds = "",
           .lacks = "",
           .options = {}},
          echo};
}

formats::Case twoNodes() {
  formats::Case value;
  value.tree.centre = {{0, 0, 0}, {0, 0, 1}};
  value.tree.direction = {{0, 0, 1}, {0, 0, 1}};
  value.tree.radius = {1, 1};
  value.tree.height = {1, 1};
  value.tree.parent = {-1, 0};
  value.tree.branch = {0, 0};
  formats::Branch& branch = value.tree.branches.emplace_back();
  branch.label.assign(1, 'a');  // gcc 12 warns of "a"
  branch.nodeCount = 2;
  value.models = formats::BlobbyModels{};
  value.models->offset = {0, 1, 2};
  value.models->centre = {{0, 0, 0}, {0, 0, 1}};
  value.models->width = {1, 1};
  return value;
}

ExportResult exported(const ExportOptions& options, const formats::Case& value) {
  Progress progress;
  return exportCase(target(), value, options, {{"--edge", "0.5r"}}, progress);
}

std::string errorOf(const ExportOptions& options, const formats::Case& value) {
  try {
    exported(options, value);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(ExportCase, DescribesTheFolderInItsOwnUnitAndAxes) {
  const ExportResult result = exported({}, twoNodes());
  ASSERT_EQ(result.files.size(), 3U);
  EXPECT_EQ(result.files[1].name, "README.md");
  EXPECT_EQ(result.files[2].name, "lumen-export.json");
  const auto said = nlohmann::json::parse(result.files[2].bytes);
  EXPECT_EQ(said["unit"], "m");
  EXPECT_EQ(said["axes"], "LSA");
  EXPECT_EQ(said["options"]["--edge"], "0.5r");
  EXPECT_EQ(said["files"][0]["unit"], "cm");
  // SHA-256 of "m"
  EXPECT_EQ(said["files"][0]["sha256"],
            "62c66a7a5dd70c3146618063c344e531e6d4b59e379808443ce962b3abd63c5a");
  EXPECT_NEAR(double(said["ends"][0]["position"][1]), 0.030, 1e-12);
  EXPECT_NEAR(double(said["ends"][0]["radius"]), 0.002, 1e-12);
  EXPECT_EQ(said["losses"][0], "nothing is | lost");
}

TEST(ExportCase, KeepsTextsOfACaseOutOfTheMarksOfItsReadme) {
  const std::string readme = exported({}, twoNodes()).files[1].bytes;
  EXPECT_NE(readme.find("in\\|let"), std::string::npos);
  EXPECT_NE(readme.find("`place.txt` | a unit"), std::string::npos);
}

TEST(ExportCase, TakesTheUnitThatIsChosenIfTheTargetReadsIt) {
  ExportOptions options;
  options.unit = LengthUnit::Centimetre;
  EXPECT_EQ(exported(options, twoNodes()).files[0].bytes, "cm");
  options.unit = LengthUnit::Millimetre;
  EXPECT_EQ(errorOf(options, twoNodes()),
            "unit: found mm, expected m or cm, which is what echo reads");
  options.unit.reset();
  options.axes = Axes::Lps;
  EXPECT_EQ(errorOf(options, twoNodes()), "up: found z, expected y, which is what echo reads");
}

TEST(ExportCase, NamesFieldsByTheWordOfItsOptions) {
  ExportOptions options;
  options.word = FieldWord(
      [](std::string_view field, auto) { return std::string("<").append(field).append(">"); });
  options.axes = Axes::Lps;
  EXPECT_EQ(errorOf(options, twoNodes()), "<up>: found z, expected y, which is what echo reads");
}

TEST(ExportCase, HasEdgesOfHalfARadiusUnlessItIsAskedForOthers) {
  EXPECT_EQ(ExportOptions().surface.edge.share, 0.5);
}

TEST(ExportCase, RefusesWhatIsNotThere) {
  formats::Case bare = twoNodes();
  bare.models.reset();
  EXPECT_NE(errorOf({}, bare).find("lumen fit makes them"), std::string::npos);
  formats::Case sac = twoNodes();
  sac.tree.branches[0].kind = formats::BranchKind::Aneurysm;
  EXPECT_NE(errorOf({}, sac).find("no vessel with a length"), std::string::npos);
}

TEST(ExportCase, StatesWhatTheReaderOfTheVolumeTookForGranted) {
  formats::Case value = twoNodes();
  EXPECT_TRUE(exported({}, value).assumptions.empty());
  value.metadata.steps = {{"track", "lumen", {}}, {"track", "lumen", {}}};
  for (formats::Step& step : value.metadata.steps)
    recordAssumptions(step, {"left may be right", "up may be down"});
  const ExportResult result = exported({}, value);
  EXPECT_EQ(result.assumptions, (std::vector<std::string>{"left may be right", "up may be down"}));
  EXPECT_EQ(result.remarks.size(), 2U);
  const auto readme = std::find_if(result.files.begin(), result.files.end(),
                                   [](const ExportFile& file) { return file.name == "README.md"; });
  ASSERT_NE(readme, result.files.end());
  for (const char* sentence : {"left may be right", "up may be down"})
    EXPECT_NE(readme->bytes.find(sentence), std::string::npos) << readme->bytes;
}

}  // namespace lumen::convert
