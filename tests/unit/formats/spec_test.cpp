// SPDX-License-Identifier: Apache-2.0
// The specification and the code say the same.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "formats/case/chunks.h"
#include "formats/case/enum_names.h"
#include "formats/case/limits.h"
#include "unit/formats/sample_case.h"

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

// What stands between the fences of the only block of that language.
std::string block(const std::string& language) {
  const std::string text = specification();
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST(Specification, ListsEveryErrorWithItsMeaningAndNoOther) {
  const std::string text = specification();
  const std::string table =
      text.substr(text.find("## Errors"), text.find("## Example") - text.find("## Errors"));
  std::size_t rows = 0;
  for (std::size_t at = table.find("\n| `"); at != std::string::npos;
       at = table.find("\n| `", at + 1))
    ++rows;
  EXPECT_EQ(rows, errorRules().size());
  for (const ErrorRule& rule : errorRules()) {
    std::string row = "| `";
    row.append(rule.name).append("` | ").append(rule.meaning).append(" |\n");
    EXPECT_TRUE(contains(table, row)) << row;
  }
}

TEST(Specification, ListsEveryChunkAndWhetherItIsCritical) {
  const std::string text = specification();
  for (const ChunkRule& rule : kChunkRules) {
    const std::string row =
        "| `" + chunkName(rule.type) + (rule.critical ? "` | yes |" : "` | no |");
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
      {"| bytes of a label; of a name of a step, tool or parameter | ", kMaxNameBytes},
      {"| bytes of a parameter that is a text | ", kMaxTextBytes},
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
