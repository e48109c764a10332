// SPDX-License-Identifier: Apache-2.0
// lumen names, from outside.
#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

/// A case of a vessel and a branch of it.
class NamesTest : public CliTest {
protected:
  void SetUp() override {
    write("y.swc",
          "1 2 0 0 0 2 -1\n2 2 0 0 5 2 1\n3 2 0 0 10 2 2\n4 2 3 0 13 1 3\n5 2 6 0 16 1 4\n"
          "6 2 -3 0 13 1 3\n7 2 -6 0 16 1 6\n");
    make({"convert", "y.swc", "y.lumen", "--quiet"});
    const Json answer = names({"y.lumen"});
    for (const Json& row : answer["names"]) m_names.push_back(row["name"]);
    ASSERT_EQ(m_names.size(), 2U);
  }

  [[nodiscard]] Json names(std::vector<std::string> words) const {
    words.insert(words.begin(), "names");
    words.emplace_back("--json");
    const Outcome outcome = lumen(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }

  std::vector<std::string> m_names;
};

}  // namespace

TEST_F(NamesTest, ATableGoesOutAndComesBackFilledIn) {
  make({"names", "y.lumen", "--table", "names.csv"});
  const std::string table = read("names.csv");
  EXPECT_TRUE(table.starts_with("name,new_name,from,length_mm,radius_mm,x_mm,y_mm,z_mm\n"));
  std::string filled = table;
  const std::string cell = "\n" + m_names[1] + ",,";
  ASSERT_TRUE(contains(filled, cell)) << table;
  filled.replace(filled.find(cell), cell.size(), "\n" + m_names[1] + ",\"right, \"\"lower\"\"\",");
  write("filled.csv", filled);
  const Json answer = names({"y.lumen", "--names", "filled.csv", "--out", "named.lumen"});
  EXPECT_EQ(answer["renamed"], 1);
  EXPECT_EQ(answer["names"][0]["name"], m_names[0]);
  EXPECT_EQ(answer["names"][1]["name"], "right, \"lower\"");
  EXPECT_EQ(answer["names"][1]["from"], m_names[0]);
  // and what was written is a table again
  make({"names", "named.lumen", "--table", "again.csv"});
  EXPECT_TRUE(contains(read("again.csv"), "\n\"right, \"\"lower\"\"\",,"));
}

TEST_F(NamesTest, TwoNamesMayChangePlaces) {
  const Json answer = names({"y.lumen", "--rename", m_names[0] + "=" + m_names[1], "--rename",
                             m_names[1] + "=" + m_names[0], "--out", "y.lumen"});
  EXPECT_EQ(answer["names"][0]["name"], m_names[1]);
  EXPECT_EQ(answer["names"][1]["name"], m_names[0]);
  EXPECT_EQ(lumen({"validate", "y.lumen"}).code, 0);
}

TEST_F(NamesTest, MistakesAreRefusedAndNothingIsWritten) {
  const auto refused = [&](const std::vector<std::string>& settings, const std::string& why) {
    std::vector<std::string> words{"names", "y.lumen", "--out", "out.lumen"};
    words.insert(words.end(), settings.begin(), settings.end());
    const Outcome outcome = lumen(words);
    EXPECT_NE(outcome.code, 0);
    EXPECT_TRUE(contains(outcome.err, why)) << outcome.err;
    EXPECT_FALSE(exists("out.lumen"));
  };
  refused({"--rename", m_names[1].substr(0, m_names[1].size() - 1) + "x=ICA"},
          "there is no branch");
  refused({"--rename", m_names[1] + "=" + m_names[0]}, "two branches would be called");
  refused({"--rename", m_names[1] + "=a", "--rename", m_names[1] + "=b"}, "two new names");
  refused({"--rename", "ICA"}, "NAME=NEW");
  refused({}, "nothing to write");
  write("other.csv", "label,new_name\n");
  refused({"--names", "other.csv"}, "no column name");
  EXPECT_EQ(lumen({"names", "y.lumen", "--rename", "a=b"}).code, 2);
  refused({"--anatomy"}, "has no source volume");
  refused({"--anatomy", "--rename", m_names[1] + "=a"}, "--rename");
}

TEST_F(NamesTest, TheCircleOfWillisGetsItsNames) {
  make({"phantom", "willis", "willis.nrrd", "--truth", "true.lumen", "--size", "64", "--voxel",
        "0.8", "--quiet"});
  const Json found = names({"true.lumen", "--anatomy"});
  ASSERT_EQ(found["anatomy"].size(), 12U);
  for (const Json& row : found["anatomy"]) {
    EXPECT_EQ(row["name"], row["branch"]);
    EXPECT_GE(row["probability"], 0.7);
  }
  EXPECT_EQ(found["renamed"], 0);
  EXPECT_TRUE(contains(lumen({"names", "true.lumen", "--anatomy"}).out, "L-Pcom"));
  // branches with automatic names, of today and of older cases, get theirs
  make({"names", "true.lumen", "--rename", "BA=A.1", "--rename", "L-MCA=vessel-2", "--out",
        "blank.lumen", "--quiet"});
  const Json named = names({"blank.lumen", "--anatomy", "--out", "named.lumen"});
  EXPECT_EQ(named["renamed"], 2);
  std::set<std::string> labels;
  for (const Json& row : named["names"]) labels.insert(row["name"]);
  EXPECT_TRUE(labels.contains("BA"));
  EXPECT_TRUE(labels.contains("L-MCA"));
  EXPECT_EQ(lumen({"validate", "named.lumen"}).code, 0);
  // nothing of a single vessel
  make({"phantom", "tube", "tube.nrrd", "--truth", "tube.lumen", "--size", "32", "--quiet"});
  EXPECT_TRUE(names({"tube.lumen", "--anatomy"})["anatomy"].empty());
}

}  // namespace lumen::test
