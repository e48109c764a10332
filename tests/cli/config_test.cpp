// SPDX-License-Identifier: Apache-2.0
// --config: its syntax, and what wins.
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

class ConfigTest : public CliTest {
protected:
  /// The edge, in voxels, of the phantom that these further arguments make.
  int sizeWith(const std::vector<std::string>& further) const {
    std::vector<std::string> arguments = {"phantom", "tube", "tube.nrrd", "--json"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    const Outcome made = lumen(arguments);
    EXPECT_EQ(made.code, 0) << made.err;
    return made.code == 0 ? nlohmann::json::parse(made.out)["size"][0].get<int>() : 0;
  }
};

TEST_F(ConfigTest, ALineSetsAnOption) {
  write("c.toml", "# the smaller the faster\nsize = 40\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml"}), 40);
}

TEST_F(ConfigTest, TheCommandLineWins) {
  write("c.toml", "size = 40\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml", "--size", "32"}), 32);
  EXPECT_EQ(sizeWith({"--size", "32", "--config", "c.toml"}), 32);
}

TEST_F(ConfigTest, TheCommandsOwnSectionWins) {
  write("c.toml", "size = 40\n[phantom]\nsize = 36\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml"}), 36);
}

TEST_F(ConfigTest, SectionsOfOtherCommandsDoNotMatter) {
  write("c.toml", "size = 40\n[track]\nrays = 42\n[fit]\nkernel = \"gaussian\"\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml"}), 40);
}

TEST_F(ConfigTest, AnUnknownKeyIsAUsageErrorThatNamesIt) {
  write("c.toml", "sizes = 40\n");
  const Outcome refused = lumen({"phantom", "tube", "tube.nrrd", "--config", "c.toml"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("sizes"), std::string::npos) << refused.err;
}

TEST_F(ConfigTest, AnUnknownSectionIsAUsageErrorThatNamesIt) {
  write("c.toml", "[phantoms]\nsize = 40\n");
  const Outcome refused = lumen({"phantom", "tube", "tube.nrrd", "--config", "c.toml"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("phantoms"), std::string::npos) << refused.err;
}

TEST_F(ConfigTest, AValueOutOfRangeIsAUsageError) {
  write("c.toml", "voxel = -1\n");
  EXPECT_EQ(lumen({"phantom", "tube", "tube.nrrd", "--config", "c.toml"}).code, 2);
}

TEST_F(ConfigTest, CommentsMayFollowOptionsAndSections) {
  write("c.toml",
        "threads = 1   # for every command\n[phantom]  # this one only\nsize = 36 # voxels\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml"}), 36);
}

TEST_F(ConfigTest, AListGoesInBrackets) {
  write("c.toml", "[info]\ncrop = [0, 31, 0, 15, 0, 7]\n");
  ASSERT_EQ(sizeWith({"--size", "32"}), 32);
  const Outcome told = lumen({"info", "tube.nrrd", "--json", "--config", "c.toml"});
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_EQ(nlohmann::json::parse(told.out)["size"], nlohmann::json({32, 16, 8}));
}

TEST_F(ConfigTest, FlagsAreSetByTrue) {
  write("c.toml", "size = 32\nquiet = true\n");
  const Outcome made = lumen({"phantom", "tube", "tube.nrrd", "--config", "c.toml"});
  EXPECT_EQ(made.code, 0);
  EXPECT_EQ(made.out + made.err, "");
}

TEST_F(ConfigTest, AnApostropheBeforeACommentIsALetter) {
  write("c.toml", "size = 36  # it's the phantom's edge\nseeds = it's.json # that's all\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml"}), 36);
  EXPECT_TRUE(exists("it's.json"));
}

TEST_F(ConfigTest, AByteOrderMarkIsNoPartOfTheFirstLine) {
  write("c.toml", "\xEF\xBB\xBFsize = 36\n");
  EXPECT_EQ(sizeWith({"--config", "c.toml"}), 36);
}

TEST_F(ConfigTest, AFileThatDoesNotEndIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  for (const char* const name : {"/dev/zero", "fifo"}) {
    const Outcome refused = lumen({"phantom", "tube", "tube.nrrd", "--config", name});
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_NE(refused.err.find("which is no regular file"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(entries(), std::vector<std::string>{"fifo"});
}

}  // namespace lumen::test
