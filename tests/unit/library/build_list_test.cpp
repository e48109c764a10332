// SPDX-License-Identifier: Apache-2.0
#include "converters/library/rows/build_list.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/library/index/record.h"
#include "tests/unit/library/temporary_folder.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

class BuildListTest : public testing::Test {
protected:
  void SetUp() override {
    for (const char* name : {"a.nrrd", "b.nrrd", "a.json"}) m_files.write(name, name);
  }
  [[nodiscard]] fs::path list() const { return m_files.path("list.csv"); }
  [[nodiscard]] std::vector<BuildRow> read(const std::string& text) const {
    BuildList all = readBuildList(text, list());
    requireNoFaults(all.faults, list());
    return all.rows;
  }
  /// Text of the refusal after the name of the file.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
      const std::string name = list().string() + ": ", what = error.what();
      EXPECT_TRUE(what.starts_with(name)) << what;
      return what.substr(std::min(what.size(), name.size()));
    }
    ADD_FAILURE() << "not refused: " << text;
    return {};
  }

private:
  TemporaryFolder m_files;
};

}  // namespace

TEST_F(BuildListTest, EveryColumnHasItsPlace) {
  const auto rows = read(
      "volume,seeds,id,targets,title,anatomy,codes,synthetic,licence,--crop\r\n"
      "a.nrrd, a.json ,left-1,sofa; mujoco,\"Siphon, \"\"left\"\"\",carotid siphon,"
      "SNOMED CT:69105007:Carotid artery;FMA:3947:Internal carotid,yes,CC0-1.0,1 2 3 4 5 6\r\n");
  ASSERT_EQ(rows.size(), 1U);
  const BuildRow& row = rows.front();
  EXPECT_EQ(row.line, 2U);
  EXPECT_EQ(row.input, list().parent_path() / "a.nrrd");
  EXPECT_EQ(row.seeds, list().parent_path() / "a.json");
  EXPECT_EQ(row.id, "left-1");
  EXPECT_EQ(row.targets, (std::vector<std::string>{"sofa", "mujoco"}));
  EXPECT_EQ(row.options.at("--crop"), "1 2 3 4 5 6");
  const CaseAbout about = readAbout(row.about, "about");
  EXPECT_EQ(about.title, "Siphon, \"left\"");
  EXPECT_EQ(about.anatomy, "carotid siphon");
  ASSERT_EQ(about.codes.size(), 2U);
  EXPECT_EQ(about.codes[1].system + about.codes[1].code + about.codes[1].name,
            "FMA3947Internal carotid");
  EXPECT_TRUE(about.synthetic);
}

TEST_F(BuildListTest, EmptyRowsAndTheMarkOfSpreadsheetsAreNoRows) {
  const auto rows = read("\xEF\xBB\xBFinput,title\na.nrrd,A\n,\n\nb.nrrd,\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].line, 2U);
  EXPECT_EQ(rows[1].line, 5U);
  EXPECT_TRUE(readAbout(rows[1].about, "about").title.empty());
  const auto partly = read("input,anatomy\na.nrrd,aorta\n");
  EXPECT_EQ(readAbout(partly[0].about, "about").anatomy, "aorta");
}

TEST_F(BuildListTest, AllFaultsAreReportedAtOnceWithTheirLines) {
  const std::string text = refusal(
      "input,id,synthetic\nmissing.nrrd,a,yes\na.nrrd,NO,yes\na.nrrd,b,perhaps\na.nrrd,c,no,more\n"
      "a.nrrd,d,no\nb.nrrd,d,no\n");
  EXPECT_NE(text.find("line 2: input: there is no "), std::string::npos) << text;
  EXPECT_NE(text.find("line 3: id: found \"NO\", expected 1 to 64 of a to z"), std::string::npos)
      << text;
  EXPECT_NE(text.find("line 4: synthetic: found \"perhaps\", expected yes or no"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("line 5: found 4 cells, expected 3"), std::string::npos) << text;
  EXPECT_NE(text.find("line 7: id: d is that of line 6, too"), std::string::npos) << text;
}

TEST_F(BuildListTest, RowsWithoutAFaultAreThereBesideThoseWithOne) {
  const BuildList all =
      readBuildList("input,id\nmissing.nrrd,a\na.nrrd,b\nb.nrrd,b\nb.nrrd,c\na.nrrd,No\n", list());
  ASSERT_EQ(all.rows.size(), 2U);
  EXPECT_EQ(all.rows[0].id, "b");
  EXPECT_EQ(all.rows[1].id, "c");
  std::map<std::size_t, std::string> ids;
  for (const RowFault& fault : all.faults) ids[fault.line] = fault.id;
  EXPECT_EQ(ids, (std::map<std::size_t, std::string>{{2, "a"}, {4, "b"}, {6, ""}}));
}

TEST_F(BuildListTest, WhatIsNoListIsRefused) {
  EXPECT_EQ(refusal("").find("is empty"), 0U);
  EXPECT_EQ(refusal("input\n"), "there is no row below the names");
  EXPECT_EQ(refusal("title\nA\n"), "line 1: there is no column called input");
  EXPECT_EQ(
      refusal("input,volume\na.nrrd,a.nrrd\n").find("line 1: two columns are called \"input\""),
      0U);
  EXPECT_EQ(refusal("input,colour\na.nrrd,red\n")
                .find("line 1: found a column \"colour\", expected input"),
            0U);
  EXPECT_EQ(refusal("input;title\na.nrrd;A\n").find("line 1: found a column \"input;title\""), 0U);
  EXPECT_EQ(refusal("input,title\na.nrrd,A \"quote\n").find("line 2: found a quote inside"), 0U);
  EXPECT_EQ(refusal("input,title\na.nrrd,\"no end\n").find("line 2: found a quote"), 0U);
  EXPECT_EQ(refusal("input,title\na.nrrd,\xFF\n"), "line 2: title: is not UTF-8");
  EXPECT_NE(refusal("input,codes\na.nrrd,SNOMED\n").find("expected SYSTEM:CODE:NAME"),
            std::string::npos);
}

TEST_F(BuildListTest, AnAddressIsNoInput) {
  const std::string text = refusal("input\nhttps://me:word@example.org/a.nrrd\n");
  EXPECT_TRUE(text.starts_with("line 2: input: found an address")) << text;
  EXPECT_EQ(text.find("word"), std::string::npos) << text;
}

TEST_F(BuildListTest, RowsOfSomeLinesAreReadAlone) {
  const std::string text = "input,id\na.nrrd,a\nmissing.nrrd,NO\nb.nrrd,b\n";
  const BuildList one = readBuildList(text, list(), {4});
  ASSERT_EQ(one.rows.size(), 1U);
  EXPECT_TRUE(one.faults.empty());
  EXPECT_EQ(one.rows.front().id, "b");
  EXPECT_EQ(one.rows.front().line, 4U);
  const BuildList none = readBuildList(text, list(), {2, 9});
  ASSERT_EQ(none.faults.size(), 1U);
  EXPECT_EQ(none.faults.front().line, 9U);
  EXPECT_EQ(none.faults.front().why, "no row begins there");
}

}  // namespace lumen::convert
