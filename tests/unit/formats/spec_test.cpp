// SPDX-License-Identifier: Apache-2.0
// The specification, the code, the schemas and the tests say the same.
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "formats/case/enum_names.h"
#include "formats/view/case_chunks.h"
#include "formats/view/limits.h"
#include "unit/formats/sample_case.h"
#include "unit/formats/spec_tables.h"

namespace lumen::formats {
namespace {

std::string specification() {
  std::ifstream in(LUMEN_TEST_DATA "/../../spec/lumen.md", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_FALSE(text.empty());
  return text;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string numbered(const std::string& name, std::size_t value) {
  return "| `" + name + "` | " + std::to_string(value) + " |";
}

// Text between the fences of the only block of that language.
std::string block(const std::string& language) {
  const std::string text = specification();
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

const std::filesystem::path kSpec = LUMEN_TEST_DATA "/../../spec";
const std::filesystem::path kTests = LUMEN_TEST_DATA "/..";

// `ninja write_spec && tests/write_spec ../../spec ../../tests` in the build folder makes them
// anew.
TEST(Specification, HasTheErrorsOfTheCode) {
  EXPECT_EQ(test::readText(kSpec / "errors.md"), test::errorsPage());
}

TEST(Specification, HasThePropertiesOfTheSchemas) {
  const std::string text = specification();
  EXPECT_EQ(text, test::specificationWithTables(text, test::propertyTables(kSpec / "schema")));
}

TEST(Specification, HasATestForEveryRequirement) {
  std::set<std::string> tested;
  for (const auto& reference : test::testReferences(kTests)) tested.insert(reference.number);
  std::set<std::string> known;
  for (const auto& requirement : test::requirements(specification())) {
    EXPECT_TRUE(known.insert(requirement.number).second) << requirement.number << " occurs twice";
    EXPECT_TRUE(tested.contains(requirement.number)) << requirement.number << " has no test";
  }
  for (const std::string& number : tested)
    EXPECT_TRUE(known.contains(number)) << number << " is no requirement";
}

TEST(Specification, HasTheTableFromRequirementsToTests) {
  EXPECT_EQ(test::readText(kSpec / "coverage.md"), test::coveragePage(specification(), kTests));
}

TEST(Specification, ListsEveryChunkAndWhetherItIsCritical) {
  const std::string text = specification();
  for (const ChunkRule& rule : kChunkRules) {
    const std::string needed = rule.need == ChunkNeed::Always   ? "always"
                               : rule.need == ChunkNeed::Points ? "points"
                               : rule.need == ChunkNeed::Models ? "models"
                                                                : "";
    const std::string row = "| `" + chunkName(rule.type) +
                            (rule.critical ? "` | yes |" : "` | no |") +
                            (needed.empty() ? "" : " " + needed) + " | ";
    EXPECT_TRUE(contains(text, row)) << row;
  }
}

TEST(Specification, NumbersKindsStopReasonsAndKernelsAsTheCodeDoes) {
  const std::string text = specification();
  for (const auto names : {std::span<const std::string_view>(kBranchKindNames),
                           std::span<const std::string_view>(kStopReasonNames),
                           std::span<const std::string_view>(kKernelNames)})
    for (std::size_t i = 0; i < names.size(); ++i)
      EXPECT_TRUE(contains(text, numbered(std::string(names[i]), i))) << names[i];
}

TEST(Specification, StatesTheLimitsOfTheCode) {
  const std::string text = specification();
  const std::pair<const char*, std::size_t> limits[] = {
      {"| nodes | ", kMaxNodes},
      {"| points | ", kMaxPoints},
      {"| blobs | ", kMaxBlobs},
      {"| branches | ", kMaxBranches},
      {"| steps | ", kMaxSteps},
      {"| chunks in a file | ", kMaxChunks},
      {"| parameters of a step | ", kMaxParameters},
      {"| links | ", kMaxLinks},
      {"| times of a motion | ", kMaxTimes},
      {"| poses: times by moving nodes | ", kMaxPoses},
      {"| extensions used | ", kMaxExtensions},
      {"| node arrays | ", kMaxNodeArrays},
      {"| components of a node array | ", kMaxComponents},
      {"| chunks of unknown types that are not critical | ", kMaxOtherChunks},
      {"| raw size of an encoded chunk, in stored sizes | ", kMaxExpansion},
      {"| bytes of a label, a name or a unit | ", kMaxNameBytes},
      {"| bytes of the note; of a parameter that is a text | ", kMaxTextBytes},
      {"| levels of nested JSON arrays and objects | ", kMaxJsonDepth}};
  for (const auto& [row, value] : limits)
    EXPECT_TRUE(contains(text, row + std::to_string(value) + " |")) << row;
}

TEST(Specification, ShowsTheSmallestCaseInHexadecimal) {
  test::Bytes file(1216);
  std::istringstream lines(block("hex"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, 6 + 16 * 3));
    std::size_t offset = 0;
    words >> std::hex >> offset;
    ASSERT_LE(offset + 16, file.size());
    for (std::size_t i = 0; i < 16; ++i) {
      unsigned value = 0;
      words >> value;
      file[offset + i] = static_cast<std::byte>(value);
    }
  }
  EXPECT_EQ(file, encodeBinary(test::smallestCase()));
}

TEST(Specification, ShowsTheSmallestCaseInJson) {
  EXPECT_EQ(block("json"), encodeJson(test::smallestCase()));
}

}  // namespace
}  // namespace lumen::formats
