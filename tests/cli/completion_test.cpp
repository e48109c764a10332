// SPDX-License-Identifier: Apache-2.0
// Completions that bash offers with the script of `lumen completion bash`.
#include <array>
#include <cstdio>

#include "tests/cli/run_lumen.h"

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
  EXPECT_EQ(offered("convert --to g"), "glb gltf\n");
  EXPECT_EQ(offered("convert --from nr"), "nrrd\n");
}

TEST_F(CompletionTest, FileNamesAreLeftToTheShell) {
  EXPECT_EQ(offered("convert a"), "\n");
}

TEST_F(CompletionTest, AnotherShellIsAUsageError) {
  EXPECT_EQ(lumen({"completion", "tcsh"}).code, 2);
}

}  // namespace lumen::test
