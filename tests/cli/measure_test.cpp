// SPDX-License-Identifier: Apache-2.0
// lumen measure, and centerlines of other programs in and out, from outside.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "converters/base/csv_rows.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

using MeasureTest = FittedTubeTest;

TEST_F(MeasureTest, AnswersWithNumbersThatHoldTheTruth) {
  const Outcome made = lumen({"measure", "tube.lumen", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Json vessel = Json::parse(made.out)["cases"][0]["vessels"][0];
  const Json truth = Json::parse(lumen({"info", "truth.lumen", "--json"}).out)["branches"][0];
  const auto radius = truth["radius_mm"]["mean"].get<double>();
  const Json& found = vessel["mean_radius_mm"];
  EXPECT_NEAR(found["value"].get<double>(), radius, found["plus_minus"].get<double>());
  EXPECT_LT(found["plus_minus"].get<double>(), 0.1 * radius);
  EXPECT_NEAR(vessel["tortuosity"]["value"].get<double>(), 0, 0.001);
}

TEST_F(MeasureTest, WritesAFolderOfTablesOneTableOrJson) {
  const Outcome folder =
      lumen({"measure", "tube.lumen", "truth.lumen", "--out", "tables", "--json"});
  ASSERT_EQ(folder.code, 0) << folder.err;
  EXPECT_NE(folder.err.find("truth.lumen: has no models"), std::string::npos);
  EXPECT_EQ(Json::parse(folder.out)["files"],
            Json({"tables/stations.csv", "tables/vessels.csv", "tables/paths.csv",
                  "tables/forks.csv", "tables/narrowings.csv", "tables/sacs.csv"}));
  const auto vessels = convert::csvRows(read("tables/vessels.csv"), "vessels.csv");
  ASSERT_EQ(vessels.size(), 3U);
  EXPECT_EQ(vessels[1].cells[0], "tube.lumen");
  EXPECT_EQ(vessels[2].cells[0], "truth.lumen");
  EXPECT_NE(vessels[2].cells.back().find("volume_mm3: the case has no models"), std::string::npos);

  ASSERT_EQ(lumen({"measure", "tube.lumen", "--out", "all.csv"}).code, 0);
  const auto all = convert::csvRows(read("all.csv"), "all.csv");
  EXPECT_EQ(all[0].cells[6], "measure");
  EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                          [](const auto& row) { return row.cells[6] == "volume_mm3"; }));

  ASSERT_EQ(lumen({"measure", "tube.lumen", "--out", "all.json"}).code, 0);
  Json file = Json::parse(read("all.json"));
  EXPECT_EQ(file["files"], Json::array());
  EXPECT_EQ(file["cases"], Json::parse(lumen({"measure", "tube.lumen", "--json"}).out)["cases"]);
}

TEST_F(MeasureTest, TablesNameCasesWithoutTheirFolders) {
  for (const char* const folder : {"Smith^John", "Doe^Jane"}) {
    std::filesystem::create_directory(path(folder));
    write(std::string(folder) + "/tube.lumen", read("tube.lumen"));
  }
  const std::string first = path("Smith^John/tube.lumen"), second = path("Doe^Jane/tube.lumen");
  ASSERT_EQ(lumen({"measure", first, second, "--out", "both.csv"}).code, 0);
  const auto rows = convert::csvRows(read("both.csv"), "both.csv");
  EXPECT_EQ(rows[1].cells[0], "tube.lumen");
  EXPECT_EQ(rows.back().cells[0], "tube.lumen (2)");
  ASSERT_EQ(lumen({"measure", first, "--against", second, "--out", "one.json"}).code, 0);
  EXPECT_EQ(Json::parse(read("one.json"))["against"], "tube.lumen");
  for (const char* const file : {"both.csv", "one.json"})
    for (const char* const name : {"Smith", "Doe"})
      EXPECT_EQ(read(file).find(name), std::string::npos) << file;
}

TEST_F(MeasureTest, StationsFollowTheStep) {
  const auto stations = [&](const std::string& step) {
    const Outcome made = lumen({"measure", "tube.lumen", "--step", step, "--json"});
    return Json::parse(made.out)["cases"][0]["stations"];
  };
  const Json fine = stations("0.5"), coarse = stations("1");
  EXPECT_NEAR(fine[3]["along_mm"]["value"].get<double>(), 1.5, 1e-6);
  EXPECT_EQ(fine[4], [&] {
    Json same = coarse[2];
    same["taper_mm_per_mm"] = fine[4]["taper_mm_per_mm"];  // of other stations around it
    return same;
  }());
}

TEST_F(MeasureTest, AgainstItselfNothingChanges) {
  const Outcome made = lumen({"measure", "tube.lumen", "--against", "tube.lumen", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const Json answer = Json::parse(made.out);
  EXPECT_EQ(answer["against"], "tube.lumen");
  const Json change = answer["changes"]["vessel_changes"][0];
  EXPECT_EQ(change["length_mm"]["value"], 0.0);
  const double own = answer["cases"][0]["vessels"][0]["length_mm"]["plus_minus"].get<double>();
  EXPECT_NEAR(change["length_mm"]["plus_minus"].get<double>(), std::sqrt(2.0) * own, 1e-4 * own);
}

TEST_F(MeasureTest, EveryNumberOfThreadsGivesTheSameBytes) {
  const Outcome one = lumen({"measure", "tube.lumen", "--threads", "1", "--json"});
  EXPECT_EQ(one.out, lumen({"measure", "tube.lumen", "--threads", "3", "--json"}).out);
}

TEST_F(MeasureTest, RefusesWhatItCannotDo) {
  EXPECT_EQ(lumen({"measure", "none.lumen"}).code, 3);
  EXPECT_EQ(lumen({"measure", "tube.nrrd"}).code, 3);
  EXPECT_EQ(lumen({"measure", "tube.lumen", "--step", "0"}).code, 2);
  EXPECT_EQ(lumen({"measure", "tube.lumen", "--out", "tube.nrrd/x.csv"}).code, 1);
  std::filesystem::create_directory(path("full"));
  write("full/file", "");
  EXPECT_EQ(lumen({"measure", "tube.lumen", "--out", "full"}).code, 1);
  const Outcome two = lumen({"measure", "tube.lumen", "truth.lumen", "--against", "tube.lumen"});
  EXPECT_EQ(two.code, 2);
  EXPECT_NE(two.err.find("--against: found 2 cases beside it, expected one"), std::string::npos);
}

}  // namespace

using nlohmann::json;

class CenterlineTest : public CliTest {
protected:
  /// A trunk of radius 2 along z, and a child of radius 1 that leaves it squarely; 0.5 mm apart.
  void SetUp() override {
    std::string swc;
    for (int i = 0; i <= 40; ++i)
      swc += std::to_string(i + 1) + " 0 0 0 " + std::to_string(0.5 * i) + " 2 " +
             std::to_string(i == 0 ? -1 : i) + "\n";
    for (int i = 1; i <= 20; ++i)
      swc += std::to_string(41 + i) + " 0 " + std::to_string(0.5 * i) + " 0 10 1 " +
             std::to_string(i == 1 ? 21 : 40 + i) + "\n";
    write("tree.swc", swc);
  }
};

TEST_F(CenterlineTest, ATreeBecomesACaseThatIsOneLumen) {
  const Outcome made = lumen({"convert", "tree.swc", "tree.lumen", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  const json answer = json::parse(made.out);
  EXPECT_EQ(answer["branches"], 2);
  EXPECT_EQ(answer["reachable"]["length_mm"], answer["reachable"]["of_mm"]);
  EXPECT_EQ(lumen({"validate", "tree.lumen", "--strict"}).code, 0);
}

// The wall is within a hundredth of the radius of the given tube, in the middle of all places.
TEST_F(CenterlineTest, TheSurfaceIsTheTubeOfTheGivenRadii) {
  ASSERT_EQ(lumen({"convert", "tree.swc", "tree.lumen"}).code, 0);
  const Outcome compared = lumen({"compare", "tree.lumen", "tree.lumen", "--json"});
  ASSERT_EQ(compared.code, 0) << compared.err;
  const json branches = json::parse(compared.out)["branches"];
  ASSERT_EQ(branches.size(), 2U);
  EXPECT_LT(branches[0]["wall_distance_mm"]["median"].get<double>(), 0.01 * 2) << compared.out;
  EXPECT_LT(branches[1]["wall_distance_mm"]["median"].get<double>(), 0.01 * 1) << compared.out;
}

TEST_F(CenterlineTest, EveryFormatTakesTheTreeThereAndBack) {
  ASSERT_EQ(lumen({"convert", "tree.swc", "tree.lumen"}).code, 0);
  for (const char* name : {"a.swc", "a.tre", "a.centerline.vtp", "a.mrk.json"}) {
    const Outcome out = lumen({"convert", "tree.lumen", name});
    ASSERT_EQ(out.code, 0) << out.err;
    ASSERT_EQ(lumen({"convert", "tree.lumen", name}).code, 0) << "once more";
    const Outcome back = lumen({"convert", name, "back.lumen", "--json"});
    ASSERT_EQ(back.code, 0) << back.err;
    EXPECT_EQ(json::parse(back.out)["branches"], 2) << name;
    const Outcome info = lumen({"info", name, "--json"});
    ASSERT_EQ(info.code, 0) << info.err;
    EXPECT_NEAR(json::parse(info.out)["length_mm"].get<double>(), 30, 0.01) << name;
    EXPECT_EQ(json::parse(info.out)["radius_mm"]["max"], 2) << name;
  }
}

TEST_F(CenterlineTest, OnePointAndLinesOfNoLengthAreRefused) {
  write("point.swc", "1 0 0 0 0 1 -1\n");
  write("still.swc", "1 0 5 5 5 1 -1\n2 0 5 5 5 1 1\n");
  const Outcome point = lumen({"convert", "point.swc", "x.lumen"});
  EXPECT_EQ(point.code, 3);
  EXPECT_NE(point.err.find("point.swc: holds one point"), std::string::npos) << point.err;
  const Outcome still = lumen({"convert", "still.swc", "x.lumen"});
  EXPECT_EQ(still.code, 3);
  EXPECT_NE(still.err.find("still.swc: holds lines of no length"), std::string::npos) << still.err;
  EXPECT_FALSE(exists("x.lumen"));
}

TEST_F(CenterlineTest, APhantomIsDrawnOfWhatLumenWritesAsSwc) {
  ASSERT_EQ(lumen({"convert", "tree.swc", "tree.lumen"}).code, 0);
  ASSERT_EQ(lumen({"convert", "tree.lumen", "again.swc"}).code, 0);
  const Outcome drawn = lumen({"phantom", "--tree", "again.swc", "a.nrrd", "--voxel", "0.5"});
  EXPECT_EQ(drawn.code, 0) << drawn.err;
}

TEST_F(CenterlineTest, ATreeBecomesAMeshInOneCommand) {
  const Outcome made = lumen({"convert", "tree.swc", "tree.glb"});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(exists("tree.glb"));
}

TEST_F(CenterlineTest, CurvesOfAFolderAreOneTree) {
  ASSERT_EQ(lumen({"convert", "tree.swc", "tree.lumen"}).code, 0);
  ASSERT_EQ(lumen({"convert", "tree.lumen", "all.mrk.json"}).code, 0);
  json all = json::parse(read("all.mrk.json"));
  std::filesystem::create_directory(path("curves"));
  for (std::size_t i = 0; i < 2; ++i) {
    json one = all;
    one["markups"] = json::array({all["markups"][i]});
    std::ofstream(path("curves/" + std::to_string(i) + ".mrk.json")) << one;
  }
  const Outcome info = lumen({"info", "curves", "--json"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(json::parse(info.out)["branches"], 2);
  EXPECT_EQ(json::parse(info.out)["trees"], 1);
}

TEST_F(CenterlineTest, ACurveWithRadiiIsStillTakenAsSeeds) {
  ASSERT_EQ(lumen({"phantom", "tube", "tube.nrrd", "--size", "64", "--truth", "t.lumen"}).code, 0);
  ASSERT_EQ(lumen({"convert", "t.lumen", "t.mrk.json"}).code, 0);
  const Outcome out = lumen({"convert", "tube.nrrd", "a.lumen", "--seeds", "t.mrk.json"});
  EXPECT_EQ(out.code, 0) << out.err;
}

TEST_F(CenterlineTest, UnitAndFrameAreTheUsersToSay) {
  const Outcome info = lumen({"info", "tree.swc", "--unit", "cm", "--json"});
  ASSERT_EQ(info.code, 0);
  EXPECT_EQ(json::parse(info.out)["length_mm"], 300);
  ASSERT_EQ(lumen({"convert", "tree.swc", "a.lumen.json", "--frame", "ras"}).code, 0);
  EXPECT_EQ(
      json::parse(read("a.lumen.json"))["tree"]["centre"].dump().find("-10") != std::string::npos,
      true);
}

TEST_F(CenterlineTest, LinksThatAreLostAreReported) {
  ASSERT_EQ(lumen({"convert", "tree.swc", "a.lumen.json"}).code, 0);
  json value = json::parse(read("a.lumen.json"));
  value["tree"]["links"] = {{0, 60}};
  write("a.lumen.json", value.dump());
  const Outcome out = lumen({"convert", "a.lumen.json", "b.swc"});
  EXPECT_EQ(out.code, 0) << out.err;
  EXPECT_NE(out.err.find("1 link that closes a loop is left out"), std::string::npos) << out.err;
}

}  // namespace lumen::test
