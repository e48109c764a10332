// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/exported.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace lumen::operations {
namespace {

class HeardWarnings : public Progress {
public:
  void warn(std::string_view message) override { said.emplace_back(message); }
  std::vector<std::string> said;
};

/// A target that writes the word of a field, and lacks something.
convert::ExportResult writeWord(const convert::ExportInput& input, const convert::ExportOptions&) {
  convert::ExportResult result;
  result.files = {{"word.txt", input.field("edge"), "", ""}};
  result.losses = {"a coarser " + input.field("grid") + " is lost"};
  return result;
}

const convert::ExportTarget& echoTarget() {
  static const convert::ExportTarget echo = {{.name = "echo",
                                              .title = "Echo",
                                              .files = {},
                                              .units = {convert::LengthUnit::Metre},
                                              .axes = {convert::Axes::Lps},
                                              .holds = "",
                                              .lacks = "",
                                              .options = {},
                                              .needsModels = false,
                                              .needsVessel = false},
                                             writeWord};
  return echo;
}

TEST(Exported, NamesFieldsByTheWordOfItsContext) {
  HeardWarnings warnings;
  const Context context{warnings, [](std::string_view field, auto) {
                          return std::string("<").append(field).append(">");
                        }};
  const convert::ExportResult result =
      exported({}, "a.lumen", {echoTarget(), {}, {}, "out\n"}, context);
  EXPECT_EQ(result.files.at(0).bytes, "<edge>");
  ASSERT_EQ(warnings.said.size(), 1U);
  EXPECT_EQ(warnings.said[0], "out\\u000a: a coarser <grid> is lost [export-loss]");
}

TEST(Exported, HasTheTwoFilesOfEveryFolder) {
  Progress silent;
  const convert::ExportResult result =
      exported({}, "a.lumen", {echoTarget(), {}, {{"edge", "0.5r"}}}, Context{silent});
  ASSERT_EQ(result.files.size(), 3U);
  EXPECT_EQ(result.files[0].bytes, "edge");
  EXPECT_EQ(result.files[1].name, "README.md");
  EXPECT_EQ(result.files[2].name, "lumen-export.json");
  EXPECT_NE(result.files[2].bytes.find("\"edge\": \"0.5r\""), std::string::npos);
}

TEST(Exported, BlamesACaseThatTheTargetCannotHoldByItsName) {
  convert::ExportTarget needing = echoTarget();
  needing.needsModels = true;
  Progress silent;
  try {
    exported({}, "a.lumen", {needing}, Context{silent});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_EQ(std::string(error.what()).find("a.lumen: this case has no models"), 0U);
  }
}

}  // namespace
}  // namespace lumen::operations
