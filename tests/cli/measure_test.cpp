// SPDX-License-Identifier: Apache-2.0
// lumen measure, from outside.
#include <algorithm>
#include <cmath>

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
  const Json truth = Json::parse(lumen({"info", "truth.lumen", "--json"}).out)["branch_table"][0];
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

}  // namespace lumen::test
