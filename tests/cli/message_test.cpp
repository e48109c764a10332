// SPDX-License-Identifier: Apache-2.0
// Changes of every message before it is shown, and suggestions for a slip.
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/cli/commands.h"
#include "converters/engine/answers/answer_text.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

TEST(MessageText, AddressesOfObjectsAreLeftOut) {
  EXPECT_EQ(messageText("itk::ERROR: NrrdImageIO(0x55d0c0ffee00): no such key"),
            "itk::ERROR: NrrdImageIO: no such key");
  EXPECT_EQ(messageText("at 0x7ffe12345678 or 0x55D0C0FFEE00"), "at  or ");
}

TEST(MessageText, OtherHexadecimalNumbersStay) {
  EXPECT_EQ(messageText("checksum 0xdeadbeef, tag (0x0008)"), "checksum 0xdeadbeef, tag (0x0008)");
}

TEST(MessageText, ControlCharactersAreEscapedAndLinesStayLines) {
  EXPECT_EQ(messageText("a\x1b[2J\r\nb"), "a\\u001b[2J\\u000d\nb");
}

TEST(Suggestion, ASlipIsAnInsertedDroppedReplacedOrSwappedLetter) {
  const std::vector<std::string> options = {"--seeds", "--series", "--dark", "--step"};
  for (const char* typed : {"--seed", "--seedss", "--sedes", "--saeds", "-seeds", "--SEEDS"})
    EXPECT_EQ(closest(typed, options), "--seeds") << typed;
}

TEST(Suggestion, TheBeginningOfOneNameMeansThatName) {
  EXPECT_EQ(closest("gau", {"cauchy", "gaussian"}), "gaussian");
  EXPECT_EQ(closest("com", {"compare", "completion"}), "");
}

TEST(Suggestion, NothingNearIsNoSuggestion) {
  EXPECT_EQ(closest("polish", {"convert", "track", "fit"}), "");
  EXPECT_EQ(closest("", {"fit"}), "");
  EXPECT_EQ(didYouMean("polish", {"convert"}), "");
  EXPECT_EQ(didYouMean("confert", {"convert"}), "; did you mean convert?");
}

}  // namespace lumen::test

namespace lumen::engine {

TEST(OperationMessage, WordsAFieldAsItsOptionAndAValueAsItWasGiven) {
  std::vector<std::string> roots;
  OptionTable table;
  table.add("root", &roots, "X,Y,Z", "").many();
  table.set("root", {"1,2,3", "4.50,5,6"});
  Progress progress;
  const operations::Context context = operationContext(progress, &table);
  EXPECT_EQ(context.field("root", 1), "--root 4.50,5,6");
  EXPECT_EQ(context.field("root"), "--root");
  EXPECT_EQ(context.field("seeds"), "--seeds");
}

}  // namespace lumen::engine

// Completions that bash offers with the script of `lumen completion bash`.
namespace lumen::test {

class CompletionTest : public CliTest {
protected:
  void SetUp() override {
    const Outcome script = lumen({"completion", "bash"});
    ASSERT_EQ(script.code, 0) << script.err;
    write("script", script.out);
  }

  /// The words offered for the last of `words`, which follow the program's name.
  [[nodiscard]] std::string offered(const std::string& words) const {
    write("ask", "source '" + path("script").string() + "'; COMP_WORDS=(lumen " + words +
                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _lumen; echo \"${COMPREPLY[*]}\"");
    std::string text;
    FILE* shell = popen(("bash '" + path("ask").string() + "' 2>&1").c_str(), "r");
    std::array<char, 256> line{};
    while (std::fgets(line.data(), line.size(), shell) != nullptr) text += line.data();
    pclose(shell);
    return text;
  }
};

TEST_F(CompletionTest, Commands) {
  EXPECT_EQ(offered("comp"), "compare completion\n");
}

TEST_F(CompletionTest, OptionsOfTheCommand) {
  EXPECT_EQ(offered("validate --m"), "--max-issues\n");
  EXPECT_EQ(offered("fit --thr"), "--threads\n");
}

TEST_F(CompletionTest, FormatsOfFromAndTo) {
  EXPECT_EQ(offered("convert --to g"), "glb gltf graphml\n");
  EXPECT_EQ(offered("convert --from nr"), "nrrd\n");
}

TEST_F(CompletionTest, WordsThatAnOptionTakes) {
  EXPECT_EQ(offered("picture a.lumen a.png --view an"), "anterior\n");
}

TEST_F(CompletionTest, CommandsAndTopicsOfHelp) {
  EXPECT_EQ(offered("help measu"), "measure measures\n");
}

TEST_F(CompletionTest, EveryShellCompletesEveryOptionOfEveryCommand) {
  const std::string fish = lumen({"completion", "fish"}).out,
                    zsh = lumen({"completion", "zsh"}).out;
  for (const auto& [command, table] : cli::allCommands().commands())
    for (const OptionRow& row : table->rows()) {
      if (row.isArgument) continue;
      const std::string within = "'__lumen_within " + command->name() + "' -l " + row.name + " -d ";
      EXPECT_TRUE(contains(fish, within)) << within;
      EXPECT_TRUE(contains(zsh, " '" + row.shownName() + ":")) << row.name;
    }
}

TEST_F(CompletionTest, FileNamesAreLeftToTheShell) {
  EXPECT_EQ(offered("convert a"), "\n");
}

TEST_F(CompletionTest, AnotherShellIsAUsageError) {
  EXPECT_EQ(lumen({"completion", "tcsh"}).code, 2);
}

}  // namespace lumen::test
