// SPDX-License-Identifier: Apache-2.0
// Help, arguments that are refused, and the exit code of each class of failure.
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

const std::vector<std::string> kCommands = {"convert", "track",    "fit",     "trim",      "info",
                                            "compare", "validate", "phantom", "completion"};

}  // namespace

using UsageTest = CliTest;

TEST_F(UsageTest, TheHelpOfEveryCommandEndsWithAnExampleAndTheExitCodes) {
  for (const auto& command : kCommands) {
    const Outcome help = lumen({command, "--help"});
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_EQ(help.err, "") << command;
    EXPECT_TRUE(contains(help.out, "Example:\n  lumen " + command)) << help.out;
    EXPECT_TRUE(contains(help.out, "130 interrupted")) << help.out;
  }
}

TEST_F(UsageTest, EveryCommandTakesTheCommonOptions) {
  for (const auto& command : kCommands) {
    const std::string help = lumen({command, "--help"}).out;
    for (const char* option :
         {"--threads", "--quiet", "--verbose", "--strict", "--config", "--json"})
      EXPECT_TRUE(contains(help, option)) << command << " " << option;
  }
}

TEST_F(UsageTest, TheTopLevelHelpListsEveryCommand) {
  const Outcome help = lumen({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const auto& command : kCommands) EXPECT_TRUE(contains(help.out, "\n  " + command + " "));
}

TEST_F(UsageTest, TheHelpShowsTheDefaultsOfTheMethod) {
  const std::string help = lumen({"convert", "--help"}).out;
  for (const char* text :
       {"--inlier-rate SHARE=0.7", "--inlier-band SHARE=0.1", "--rays N=162", "--axes N=81",
        "--samples N=128", "--min-trials N=220", "--max-trials N=500", "--step S=0.5",
        "--cohesion-weight W=1e-05", "--curvature-weight W=0.001", "--max-subdivisions N=100"})
    EXPECT_TRUE(contains(help, text)) << text << "\n" << help;
}

TEST_F(UsageTest, TheExecutableAnswersAsTheCommandLineInThisProcess) {
  write("a.lumen", "this is not a case");
  const std::vector<std::pair<int, std::vector<std::string>>> runs = {
      {0, {"info", "--help"}},
      {0, {"--version", "--json"}},
      {1, {"convert", "a.lumen", "gone/b.lumen"}},
      {2, {"polish"}},
      {3, {"info", "a.lumen"}},
      {4, {"convert", "a.lumen", "b.docx"}}};
  for (const auto& [code, arguments] : runs) {
    const Outcome program = lumenProgram(arguments), here = lumen(arguments);
    EXPECT_EQ(program.code, code) << arguments[0];
    EXPECT_EQ(program.code, here.code) << arguments[0];
    EXPECT_EQ(program.out, here.out) << arguments[0];
    EXPECT_EQ(program.err, here.err) << arguments[0];
  }
}

TEST_F(UsageTest, TheVersionIsOneLine) {
  for (const char* word : {"--version", "-V", "version"}) {
    const Outcome version = lumen({word});
    EXPECT_EQ(version.code, 0);
    EXPECT_TRUE(std::regex_match(version.out, std::regex("lumen [0-9]+\\.[0-9]+\\.[0-9]+\n")))
        << version.out;
  }
}

TEST_F(UsageTest, TheVersionAsJsonNamesThatOfTheLineAndOfTheFormats) {
  const Outcome version = lumen({"--version", "--json"});
  EXPECT_EQ(version.code, 0);
  const auto answer = nlohmann::json::parse(version.out);
  EXPECT_EQ("lumen " + answer.at("version").get<std::string>() + "\n", lumen({"--version"}).out);
  EXPECT_EQ(answer.at("version"), answer.at("libblob"));
  EXPECT_EQ(answer.at("formats").at("case"), "1.2");
  EXPECT_EQ(lumen({"version", "--json"}).out, version.out);
}

TEST_F(UsageTest, TheVersionRefusesAnOptionThatWouldDoNothing) {
  const Outcome refused = lumen({"--version", "--quiet"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(contains(refused.err, "\"--quiet\"")) << refused.err;
}

TEST_F(UsageTest, HelpIsACommandToo) {
  EXPECT_EQ(lumen({"help"}).out, lumen({"--help"}).out);
  EXPECT_EQ(lumen({"help", "fit"}).out, lumen({"fit", "--help"}).out);
  EXPECT_EQ(lumen({"help", "fti"}).code, 2);
}

TEST_F(UsageTest, HelpPrintsEveryTopicThatItLists) {
  const std::string list = lumen({"help"}).out;
  std::istringstream lines(list.substr(list.find("lumen help TOPIC")));
  std::string line, name;
  std::getline(lines, line);
  std::size_t topics = 0;
  for (; std::getline(lines, line) && line.starts_with("  "); ++topics) {
    std::istringstream(line) >> name;
    const Outcome page = lumen({"help", name});
    EXPECT_EQ(page.code, 0) << name;
    const std::string title = page.out.substr(2, page.out.find('\n') - 2);
    EXPECT_TRUE(line.ends_with(" " + title)) << line << ": " << title;
    EXPECT_FALSE(contains(page.out, ".md)")) << name;
    EXPECT_FALSE(contains(page.out, ".png)")) << name;
  }
  EXPECT_GT(topics, 15U);
}

TEST_F(UsageTest, AnUnknownTopicIsAUsageErrorThatNamesTheNearestOne) {
  const Outcome unknown = lumen({"help", "volums"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err,
            "lumen: error: volums: there is no such command or topic; did you mean volumes?\n");
  EXPECT_EQ(lumen({"help", "volumes", "flow"}).code, 2);
}

TEST_F(UsageTest, NoHelpTextHasTheParsersOwnMarks) {
  std::vector<std::vector<std::string>> questions = {{"--help"}};
  for (const auto& command : kCommands) questions.push_back({command, "--help"});
  for (const auto& question : questions) {
    const std::string help = lumen(question).out;
    for (const char* mark : {"{", "}", "Excludes", "Needs", "REQUIRED", "TEXT", "INT", "FLOAT",
                             "BOOLEAN", "[default", " ...", "\n\n\n"})
      EXPECT_FALSE(contains(help, mark)) << question[0] << ": " << mark << "\n" << help;
  }
}

TEST_F(UsageTest, WrongArgumentsExitWithTwoAndSayNothingOnStandardOutput) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"polish"},
      {"convert"},
      {"convert", "one.lumen"},
      {"convert", "one.lumen", "two.lumen", "three.lumen"},
      {"info", "--nonsense", "one.lumen"},
      {"validate"},
      {"validate", "one.lumen", "--max-issues", "-1"},
      {"convert", "a.lumen", "b.lumen", "--point-bits", "31"},
      {"track", "a.nrrd", "b.lumen", "--inlier-rate", "1.5"},
      {"track", "a.nrrd", "b.lumen", "--rays", "100"},
      {"track", "a.nrrd", "b.lumen", "--samples", "many"},
      {"track", "a.nrrd", "b.lumen", "--crop", "1,2,3"},
      {"fit", "a.lumen", "b.lumen", "--kernel", "boxy"},
      {"fit", "a.lumen", "b.lumen", "--accuracy", "-1"},
      {"trim", "a.lumen", "b.lumen", "--min-radius", "0"},
      {"info", "a.lumen", "--threads", "-2"},
      {"info", "a.lumen", "--quiet", "--verbose"},
      {"phantom", "cube", "a.nrrd"},
  };
  for (const auto& arguments : wrong) {
    const Outcome refused = lumen(arguments);
    std::string line;
    for (const auto& argument : arguments) line += " " + argument;
    EXPECT_EQ(refused.code, 2) << line << "\n" << refused.err;
    EXPECT_EQ(refused.out, "") << line;
    EXPECT_TRUE(contains(refused.err, "lumen: error: ")) << line;
  }
  EXPECT_TRUE(entries().empty());
}

TEST_F(UsageTest, OptionsOfSeedsNeedSeeds) {
  ASSERT_EQ(lumen({"phantom", "tube", "a.nrrd", "--size", "32"}).code, 0);
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--seeds-only"},
                                                 {"--only-connected"},
                                                 {"--seeds-frame", "ras"},
                                                 {"--seeds-unit", "m"}}) {
    std::vector<std::string> line = {"convert", "a.nrrd", "a.lumen"};
    line.insert(line.end(), option.begin(), option.end());
    const Outcome refused = lumen(line);
    EXPECT_EQ(refused.code, 2) << option[0];
    EXPECT_TRUE(contains(refused.err, "--seeds")) << refused.err;
  }
}

TEST_F(UsageTest, AMissingInputExitsWithThreeAndIsNamed) {
  write("seeds.json", "{}");
  const std::vector<std::vector<std::string>> missing = {
      {"info", "gone.lumen"},
      {"info", "gone.nrrd"},
      {"compare", "gone.lumen", "gone.lumen"},
      {"fit", "gone.lumen", "out.lumen"},
      {"trim", "gone.lumen", "out.lumen", "--min-length", "1"},
      {"convert", "gone.lumen", "out.glb"},
      {"track", "gone.nrrd", "out.lumen", "--seeds", "seeds.json"},
      {"info", "seeds.json", "--config", "gone.toml"}};
  for (const auto& arguments : missing) {
    const Outcome refused = lumen(arguments);
    EXPECT_EQ(refused.code, 3) << arguments[0] << ": " << refused.err;
    EXPECT_TRUE(contains(refused.err, "gone.")) << refused.err;
  }
}

TEST_F(UsageTest, AMissingSeedsFileExitsWithThreeAndIsNamed) {
  write("a.nrrd", "");
  const Outcome refused = lumen({"track", "a.nrrd", "a.lumen", "--seeds", "gone.json"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.err, "gone.json")) << refused.err;
}

TEST_F(UsageTest, AFileThatIsNoCaseExitsWithThree) {
  write("a.lumen", "this is not a case");
  write("b.lumen.json", "{\"nor\": \"is this\"}");
  EXPECT_EQ(lumen({"info", "a.lumen"}).code, 3);
  EXPECT_EQ(lumen({"info", "b.lumen.json"}).code, 3);
}

TEST_F(UsageTest, AVolumeThatIsNoVolumeExitsWithThree) {
  write("a.nrrd", "this is not a volume");
  EXPECT_EQ(lumen({"info", "a.nrrd"}).code, 3);
}

TEST_F(UsageTest, UnknownFormatsExitWithFourAndListTheKnown) {
  write("a.xyz", "");
  write("a.off", "");
  write("a.lumen", "");
  const std::vector<std::vector<std::string>> unknown = {
      {"convert", "a.xyz", "b.lumen"},
      {"convert", "a.off", "b.lumen"},
      {"convert", "a.lumen", "b.docx"},
      {"convert", "a.lumen", "b.nrrd"},
      {"convert", "a.lumen", "b.lumen", "--to", "dxf"},
      {"convert", "a.lumen", "b.lumen", "--from", "dxf"},
      {"info", "a.xyz"}};
  for (const auto& arguments : unknown) {
    const Outcome refused = lumen(arguments);
    EXPECT_EQ(refused.code, 4) << refused.err;
    EXPECT_TRUE(contains(refused.err, "lumen.json")) << refused.err;
  }
}

TEST_F(UsageTest, AnUnknownOutputIsRefusedBeforeTheInputIsLookedAt) {
  EXPECT_EQ(lumen({"convert", "gone.lumen", "b.docx"}).code, 4);
}

TEST_F(UsageTest, AnOutputInAFolderThatIsMissingExitsWithOneBeforeTheInputIsRead) {
  write("a.lumen", "this is not a case");
  const Outcome refused = lumen({"convert", "a.lumen", "gone/b.lumen"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_TRUE(contains(refused.err, "gone")) << refused.err;
}

TEST_F(UsageTest, AnOutputInAFolderThatTakesNoFilesExitsWithOneBeforeTheInputIsRead) {
  write("a.lumen", "this is not a case");
  const Outcome refused = lumen({"convert", "a.lumen", "/proc/b.lumen"});
  EXPECT_EQ(refused.code, 1) << refused.err;
}

TEST_F(UsageTest, AFolderAsOutputExitsWithOne) {
  write("a.lumen", "this is not a case");
  std::filesystem::create_directory(path("b.lumen"));
  EXPECT_EQ(lumen({"convert", "a.lumen", "b.lumen"}).code, 1);
}

}  // namespace lumen::test
