// SPDX-License-Identifier: Apache-2.0
// --config: its syntax, and what wins.
#include <nlohmann/json.hpp>

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

}  // namespace lumen::test
