// SPDX-License-Identifier: Apache-2.0
// lumen batch, from outside.
#include <algorithm>
#include <filesystem>
#include <map>

#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

/// NRRD of 24^3 voxels with noise, in which no vessel is.
std::string noise() {
  std::string text =
      "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 24 24 24\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n";
  std::uint32_t state = 7;
  for (int i = 0; i < 24 * 24 * 24; ++i) {
    state = state * 1664525U + 1013904223U;
    text += static_cast<char>(state >> 25U);
  }
  return text;
}

/// A folder `scans` with two volumes of a tube, one of noise, a damaged one, and a text.
class BatchTest : public TubeTest {
protected:
  void SetUp() override {
    TubeTest::SetUp();
    fs::create_directories(path("scans/deep"));
    fs::copy_file(path("tube.nrrd"), path("scans/Tube A.nrrd"));
    fs::copy_file(path("tube.nrrd"), path("scans/deep/b.nrrd"));
    write("scans/noise.nrrd", noise());
    write("scans/broken.nrrd", "NRRD0004\ntype: uint8\n");
    write("scans/notes.txt", "of the scanner");
  }

  struct Batch {
    int code = 0;
    Json answer;
    std::map<std::string, Json> rows;  ///< by id
  };
  [[nodiscard]] Batch batch(std::vector<std::string> words) const {
    words.insert(words.begin(), "batch");
    words.emplace_back("--json");
    const Outcome outcome = lumenProgram(words);  // which runs itself for each row
    Batch result{outcome.code, Json::parse(outcome.out, nullptr, false), {}};
    EXPECT_TRUE(result.answer.is_object()) << outcome.err;
    if (result.answer.is_object())
      for (const Json& row : result.answer["rows"]) result.rows[row["id"]] = row;
    return result;
  }
};

}  // namespace

TEST_F(BatchTest, EveryVolumeBelowAFolderGetsACaseOrAReason) {
  const Batch made = batch({"scans", "out"});
  EXPECT_EQ(made.code, 3);  // inputs alone are to blame
  EXPECT_EQ(made.answer["passed"], 2);
  EXPECT_EQ(made.answer["no_vessels"], 1);
  EXPECT_EQ(made.answer["failed"], 1);
  EXPECT_EQ(made.answer["passed_over"], 1);
  ASSERT_EQ(made.rows.size(), 4U);
  EXPECT_EQ(made.rows.at("tube-a")["input"], "Tube A.nrrd");
  EXPECT_EQ(made.rows.at("deep-b")["end"], "passed");
  EXPECT_EQ(made.rows.at("deep-b")["figures"]["vessels"], 1);
  EXPECT_EQ(made.rows.at("noise")["end"], "no_vessels");
  EXPECT_TRUE(contains(made.rows.at("broken")["why"], "broken.nrrd"));
  for (const char* file : {"out/tube-a.lumen", "out/deep-b.lumen", "out/pictures/tube-a.png"})
    EXPECT_TRUE(exists(file)) << file;
  EXPECT_FALSE(exists("out/noise.lumen"));
  EXPECT_EQ(read("out/passed.csv"), "input,id\ntube-a.lumen,tube-a\ndeep-b.lumen,deep-b\n");
  const std::string table = read("out/cases.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  EXPECT_TRUE(contains(table, "\ntube-a,Tube A.nrrd,passed,,1,1,0,"));
  const std::string page = read("out/index.html");
  EXPECT_TRUE(contains(page, "pictures/tube-a.png"));
  EXPECT_LT(page.find("broken.nrrd"), page.find("Tube A.nrrd"));  // faults first
}

TEST_F(BatchTest, AFurtherRunMakesNothingTwiceAndGoesOnWithWhatAPersonChanged) {
  fs::remove(path("scans/broken.nrrd"));
  ASSERT_EQ(batch({"scans", "out"}).code, 3);
  const std::string before = read("out/tube-a.lumen");
  const Batch again = batch({"scans", "out"});
  EXPECT_EQ(again.answer["kept"], 3);
  EXPECT_EQ(read("out/tube-a.lumen"), before);

  // a person's change is judged, and not made anew
  make({"convert", "tube.nrrd", "out/tube-a.lumen", "--seeds", "seeds.json", "--seeds-only"});
  const std::string mine = read("out/tube-a.lumen");
  ASSERT_NE(mine, before);
  const Batch changed = batch({"scans", "out"});
  EXPECT_EQ(changed.answer["kept"], 2);
  EXPECT_EQ(changed.rows.at("tube-a")["kept"], false);
  EXPECT_EQ(read("out/tube-a.lumen"), mine);

  // another option makes all anew
  const Batch other = batch({"scans", "out", "--option", "dark=false"});
  EXPECT_EQ(other.answer["kept"], 0);
  std::vector<fs::path> kept;
  for (const auto& entry : fs::directory_iterator(path("out/replaced")))
    kept.push_back(entry.path());
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(readFile(kept.front()), mine);
}

TEST_F(BatchTest, ACaseThatNoBatchMadeStays) {
  fs::create_directories(path("out"));
  write("out/tube-a.lumen", "mine");
  const Batch made = batch({"scans", "out"});
  EXPECT_EQ(made.code, 1);
  EXPECT_EQ(read("out/tube-a.lumen"), "mine");
  EXPECT_TRUE(contains(made.rows.at("tube-a")["why"], "no batch made it"));
  EXPECT_EQ(batch({"scans", "out"}).rows.at("tube-a")["end"], "failed");
}

TEST_F(BatchTest, ARowThatNeedsAPersonPassesOnceOneHasLooked) {
  write("strict.json", R"({"name": "strict", "most": {"wall_median_voxels": 0}})");
  write("list.csv", "input,id\ntube.nrrd,one\ngone.nrrd,two\n");
  const Batch made = batch({"list.csv", "out", "--profile", "strict.json"});
  EXPECT_EQ(made.code, 3);
  EXPECT_EQ(made.rows.at("one")["end"], "needs_person");
  EXPECT_TRUE(contains(made.rows.at("one")["why"], "expected at most 0"));
  EXPECT_TRUE(contains(made.rows.at("two")["why"], "there is no"));
  const Batch accepted = batch({"list.csv", "out", "--profile", "strict.json", "--accept", "one"});
  EXPECT_EQ(accepted.rows.at("one")["end"], "passed");
  const Batch unjudged = batch({"list.csv", "out", "--profile", "none"});
  EXPECT_EQ(unjudged.rows.at("one")["end"], "passed");
}

TEST_F(BatchTest, AWarningThatIsAnErrorEndsTheBatch) {
  for (const char* const other : {"scans/broken.nrrd", "scans/notes.txt"}) fs::remove(path(other));
  const Outcome strict = lumenProgram({"batch", "scans", "out", "--strict"});
  EXPECT_EQ(strict.code, 3) << strict.err;
  EXPECT_TRUE(contains(strict.err, "noise.nrrd: no vessels")) << strict.err;
  EXPECT_TRUE(exists("out/cases.csv"));
}

TEST_F(BatchTest, AnOutputInTheFolderOfInputsIsNotAnInput) {
  fs::remove(path("scans/broken.nrrd"));
  fs::remove(path("scans/noise.nrrd"));
  const Batch made = batch({"scans", "scans/cases"});
  EXPECT_EQ(made.code, 0);
  fs::copy_file(path("tube.nrrd"), path("scans/cases/not-an-input.nrrd"));
  EXPECT_EQ(batch({"scans", "scans/cases"}).rows.size(), 2U);
}

TEST_F(BatchTest, MistakesAreRefusedBeforeAnyWork) {
  EXPECT_EQ(lumen({"batch", "gone", "out"}).code, 3);
  EXPECT_EQ(lumen({"batch", "scans", "tube.nrrd"}).code, 2);
  EXPECT_EQ(lumen({"batch", "scans", "out", "--profile", "flwo"}).code, 2);
  const Outcome option = lumen({"batch", "scans", "out", "--option", "cropp=1"});
  EXPECT_EQ(option.code, 2) << option.err;
  EXPECT_TRUE(contains(option.err, "crop")) << option.err;
  const Outcome many = lumen({"convert", "scans/Tube A.nrrd", "scans/deep/b.nrrd", "scans"});
  EXPECT_EQ(many.code, 2);
  EXPECT_TRUE(contains(many.err, "lumen batch FOLDER OUT")) << many.err;
  fs::create_directories(path("empty"));
  EXPECT_EQ(lumen({"batch", "empty", "out"}).code, 3);
  EXPECT_FALSE(exists("out"));
}

TEST_F(BatchTest, AnInterruptedRunKeepsWhatWasMade) {
  fs::remove(path("scans/broken.nrrd"));
  EXPECT_EQ(lumenWithSignal({"batch", "scans", "out", "--verbose", "--jobs", "1"}, 2).code, 130);
  const Batch made = batch({"scans", "out"});
  EXPECT_EQ(made.answer["passed"], 2);
}

TEST_F(BatchTest, RowsOfAListAreMadeByTasksAndCollectedByARunOfAll) {
  write("list.csv", "input,id\nscans/Tube A.nrrd,a\nscans/deep/b.nrrd,b\n");
  for (const char* const line : {"2", "3"}) {
    const Batch task = batch({"list.csv", "out", "--rows", line});
    EXPECT_EQ(task.code, 0);
    EXPECT_EQ(task.rows.size(), 1U);
    EXPECT_EQ(task.rows.count(line == std::string("2") ? "a" : "b"), 1U);
    EXPECT_FALSE(exists("out/index.html")) << "of line " << line;
  }
  const Batch all = batch({"list.csv", "out"});
  EXPECT_EQ(all.answer["kept"], 2);
  EXPECT_EQ(read("out/passed.csv"), "input,id\na.lumen,a\nb.lumen,b\n");
}

TEST_F(BatchTest, LinesWithoutARowAndLinesOfAFolderAreRefused) {
  write("list.csv", "input,id\nscans/Tube A.nrrd,a\n");
  const Outcome missing = lumen({"batch", "list.csv", "out", "--rows", "2,7"});
  EXPECT_EQ(missing.code, 3);
  EXPECT_TRUE(contains(missing.err, "no row begins on line 7")) << missing.err;
  EXPECT_EQ(lumen({"batch", "scans", "out", "--rows", "2"}).code, 2);
  EXPECT_FALSE(exists("out"));
}

}  // namespace lumen::test
