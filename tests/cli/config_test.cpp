// SPDX-License-Identifier: Apache-2.0
// --config: its syntax, and what wins.
#include <array>
#include <bit>
#include <set>
#include <string_view>

#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "converters/base/options/option_name.h"
#include "converters/cli/command_line.h"
#include "converters/cli/commands.h"
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

namespace {

// Rules for every option of every command, found in the rows of their tables.
/// An option or a positional argument of a command.
struct Argument {
  std::string command, name, type;
  bool positional = false;
  std::size_t before = 0;  ///< positional arguments of the command
};

std::vector<Argument> everyArgument() {
  std::vector<Argument> all;
  const engine::Engine commands = cli::allCommands();
  cli::CommonOptions common;
  OptionTable shared;
  common.addRows(shared);
  for (const auto& [command, table] : commands.commands()) {
    std::size_t before = 0;
    for (const OptionTable* rows :
         {static_cast<const OptionTable*>(table.get()), static_cast<const OptionTable*>(&shared)})
      for (const OptionRow& row : rows->rows()) {
        if (!row.isFlag())
          all.push_back({command->name(), row.shownName(), row.type, row.isArgument, before});
        before += row.isArgument ? 1 : 0;
      }
  }
  return all;
}

bool isNumber(const Argument& argument) {
  static const std::set<std::string> kWords = {
      "FILE", "F",    "ID",  "NAME", "UNIT", "FRAME", "PATH", "LIST",   "LABEL", "REASON",
      "TEXT", "SPDX", "DAY", "UUID", "CODE", "DOI",   "WORD", "LENGTH", "WxH",   "[LABEL=]LENGTH"};
  return !argument.positional && !kWords.contains(argument.type);
}

bool isFile(const Argument& argument) {
  static const std::set<std::string> kWords = {"NAME", "SHELL", "TARGET", "ID"};
  return argument.positional ? !kWords.contains(argument.name)
                             : argument.type == "FILE" || argument.type == "PATH";
}

/// Names of the options of all commands, without dashes.
std::set<std::string> everyOptionName() {
  std::set<std::string> names;
  const auto take = [&names](const OptionTable& table) {
    for (const OptionRow& row : table.rows())
      if (!row.isArgument) names.insert(row.name);
  };
  const engine::Engine commands = cli::allCommands();
  for (const auto& [command, table] : commands.commands()) take(*table);
  cli::CommonOptions common;
  OptionTable shared;
  common.addRows(shared);
  take(shared);
  return names;
}

/// Exit code and standard error of a run in this process; the first argument is the name of a command.
std::pair<int, std::string> runHere(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"lumen", engine::firstWord(arguments.front())};
  if (words[1] != arguments.front()) words.push_back(arguments.front().substr(words[1].size() + 1));
  words.insert(words.end(), arguments.begin() + 1, arguments.end());
  std::vector<const char*> argv;
  for (const auto& word : words) argv.push_back(word.c_str());
  testing::internal::CaptureStderr();
  const int code = cli::runCommandLine(static_cast<int>(argv.size()), argv.data());
  return {code, testing::internal::GetCapturedStderr()};
}

}  // namespace

TEST(OptionsTest, EveryNumberIsRefusedWithWhatWasFoundAndWhatIsExpected) {
  static const std::set<std::string> kSigned = {"--time", "--lao", "--cra"};
  std::size_t numbers = 0;
  for (const Argument& argument : everyArgument()) {
    if (!isNumber(argument)) continue;
    ++numbers;
    for (const char* value : {"many", "nan", "inf", "1e999", "-1", "1 2", "0x10", ""}) {
      const auto [code, text] = runHere({argument.command, argument.name + "=" + value});
      const std::string found = *value == '\0' ? "nothing" : value;
      // times of a motion may be before 0, and angles to the other side
      if (kSigned.contains(argument.name) && std::string_view(value) == "-1") continue;
      // an empty value that is attached to its option is none at all
      if (*value == '\0' && text.find("needs a value") != std::string::npos) continue;
      EXPECT_EQ(code, 2) << argument.command << " " << argument.name << "=" << value;
      EXPECT_EQ(text.find("lumen: error: " + argument.name + ": found " + found + ", expected "),
                0U)
          << argument.command << " " << argument.name << "=" << value << "\n"
          << text;
    }
  }
  EXPECT_GT(numbers, 50U);
}

TEST(OptionsTest, EveryNameThatMessagesMentionIsThatOfARow) {
  using Names = std::array<OptionName, sizeof(OptionNames) / sizeof(OptionName)>;
  const std::set<std::string> known = everyOptionName();
  for (const OptionName& option : std::bit_cast<Names>(kOption))
    EXPECT_TRUE(known.contains(option.name)) << option.shown();
}

TEST(OptionsTest, ZerosBeforeANumberDoNotMakeItOctal) {
  EXPECT_EQ(runHere({"convert", "--rays=0162"}).second.find("found 0162, expected 12, 42"), 22U);
  EXPECT_EQ(runHere({"info", "--threads=01025"}).second.find("found 01025, expected"), 25U);
}

TEST(OptionsTest, NoFileIsCalledAHyphenOrNothing) {
  std::size_t files = 0;
  for (const Argument& argument : everyArgument()) {
    if (!isFile(argument)) continue;
    ++files;
    for (const std::string value : {"-", ""}) {
      // positional arguments are filled from the first on
      std::vector<std::string> line = {argument.command};
      if (!argument.positional) line.push_back(argument.name);
      for (std::size_t i = 0; argument.positional && i < argument.before; ++i)
        line.push_back(i > 0                           ? "x"
                       : argument.command == "phantom" ? "tube"
                       : argument.command == "export"  ? "sofa"
                                                       : "x");
      line.push_back(value);
      const auto [code, text] = runHere(line);
      EXPECT_EQ(code, 2) << argument.command << " " << argument.name;
      EXPECT_NE(text.find(argument.name + ": "), std::string::npos) << text;
      EXPECT_NE(text.find(value.empty() ? "is empty" : "standard input"), std::string::npos)
          << text;
    }
  }
  EXPECT_GT(files, 12U);
}

TEST(OptionsTest, EveryMisspeltOptionGetsItsSuggestion) {
  for (const Argument& argument : everyArgument()) {
    if (argument.positional) continue;
    const std::string typed = argument.name + "e";
    const auto [code, text] = runHere({argument.command, typed});
    EXPECT_EQ(code, 2);
    EXPECT_NE(text.find(typed + ": lumen " + argument.command + " has no such option"),
              std::string::npos)
        << text;
    // another name may be as near, such as --seeds
    EXPECT_NE(text.find("did you mean --"), std::string::npos) << text;
  }
}

}  // namespace lumen::test
