// SPDX-License-Identifier: Apache-2.0
// lumen export.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

/// A fork of vessels, tracked and fitted.
class ExportTest : public CliTest {
protected:
  void SetUp() override {
    fillOnce("fitted fork", [this] {
      make({"phantom", "bifurcation", "fork.nrrd", "--size", "64", "--seeds", "seeds.json"});
      make({"convert", "fork.nrrd", "fork.lumen", "--seeds", "seeds.json"});
    });
  }
};

TEST_F(ExportTest, WritesTheFilesThatItsListNames) {
  const Json list = Json::parse(lumen({"export", "--list", "--json"}).out);
  for (const Json& target : list["targets"]) {
    const std::string name = target["name"], folder = "out-" + name;
    const Outcome made = lumen({"export", name, "fork.lumen", folder, "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Json said = Json::parse(made.out);
    for (const Json& file : said["files"]) {
      const std::string path = folder + "/" + std::string(file["name"]);
      ASSERT_TRUE(exists(path)) << path;
      EXPECT_EQ(read(path).size(), file["bytes"]) << path;
    }
    for (const Json& file : target["files"])
      EXPECT_TRUE(exists(folder + "/" + std::string(file))) << file;
  }
}

TEST_F(ExportTest, GivesTheSameBytesAgain) {
  for (const char* const folder : {"one", "two"})
    ASSERT_EQ(lumen({"export", "sofa", "fork.lumen", folder}).code, 0);
  for (const char* const file : {"scene.scn", "scene.py", "vessel.obj", "case.lumen", "README.md"})
    EXPECT_EQ(read(std::string("one/") + file), read(std::string("two/") + file)) << file;
  EXPECT_EQ(read("one/case.lumen"), read("fork.lumen"));
}

TEST_F(ExportTest, ListsItsTargetsWithUnitAndFrame) {
  const Outcome list = lumen({"export", "--list"});
  EXPECT_EQ(list.code, 0);
  EXPECT_TRUE(contains(list.out, "sofa"));
  EXPECT_TRUE(contains(list.out, "mm; LPS"));
}

TEST_F(ExportTest, RefusesATargetThatItDoesNotKnow) {
  const Outcome refused = lumen({"export", "soda", "fork.lumen", "out"});
  EXPECT_EQ(refused.code, 4);
  EXPECT_TRUE(contains(refused.err, "did you mean sofa?")) << refused.err;
}

TEST_F(ExportTest, RefusesACaseThatIsMissing) {
  const Outcome refused = lumen({"export", "sofa", "none.lumen", "out"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.err, "none.lumen: there is no such case file")) << refused.err;
  EXPECT_FALSE(exists("out"));
}

TEST_F(ExportTest, RefusesACaseWithoutModels) {
  auto value = formats::readCaseFile(path("fork.lumen"));
  ASSERT_TRUE(value);
  value->models.reset();
  ASSERT_TRUE(formats::writeCaseFile(*value, path("bare.lumen")));
  const Outcome refused = lumen({"export", "sofa", "bare.lumen", "out", "--wall", "implicit"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.err, "lumen fit makes them")) << refused.err;
  EXPECT_FALSE(exists("out"));
}

TEST_F(ExportTest, RefusesABranchThatTheCaseHasNot) {
  const Outcome refused = lumen({"export", "sofa", "fork.lumen", "out", "--insert", "carotid"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_TRUE(contains(refused.err, "--insert carotid: no branch has this label")) << refused.err;
  EXPECT_FALSE(exists("out"));
}

TEST_F(ExportTest, RefusesAFolderWithFilesInIt) {
  ASSERT_EQ(lumen({"export", "sofa", "fork.lumen", "out"}).code, 0);
  const std::string before = read("out/scene.scn");
  const Outcome refused = lumen({"export", "sofa", "fork.lumen", "out", "--step", "0.2"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_TRUE(contains(refused.err, "out: there is something already")) << refused.err;
  EXPECT_EQ(read("out/scene.scn"), before);
}

TEST_F(ExportTest, RefusesWordsThatItDoesNotKnow) {
  for (const auto& option : {"--instrument", "--wall", "--dialect"})
    EXPECT_EQ(lumen({"export", "sofa", "fork.lumen", "out", option, "none"}).code, 2) << option;
  EXPECT_EQ(lumen({"export", "sofa", "fork.lumen", "out", "--step", "0"}).code, 2);
  const Outcome missing = lumen({"export", "sofa", "fork.lumen"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_TRUE(contains(missing.err, "FOLDER is missing")) << missing.err;
}

}  // namespace lumen::test
