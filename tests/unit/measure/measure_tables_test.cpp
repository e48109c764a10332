// SPDX-License-Identifier: Apache-2.0
// Empty values with reasons, tables, and changes between two cases.
#include "converters/judge/measure/measure_tables.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/csv_rows.h"
#include "converters/judge/measure/measure_case.h"
#include "formats/case/vessel_system.h"
#include "tests/unit/measure/shapes.h"

namespace lumen::convert::test {
namespace {

Tube childOf(int parent, double along, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             const std::string& label) {
  Tube tube = straightTube(from, to - from, (to - from).norm(), 0.8);
  tube.label = label;
  tube.parent = parent;
  tube.parentAlong = along;
  return tube;
}

/// A trunk along z with a child at its middle.
formats::Case forkCase() {
  const Tube trunk = straightTube({0, 0, 0}, {0, 0, 1}, 30, 1.5);
  return caseOf({trunk, childOf(0, 15, {0, 0, 15}, {12, 0, 21}, "a, \"b\"")}, 0.25);
}

TEST(Absent, IsACutThatMeetsAnotherVessel) {
  const CaseMeasures m = measuresOf(forkCase());
  std::size_t empty = 0;
  for (const StationMeasures& station : m.stations) {
    // the child's axis passes the wall at z = 15.75
    const bool isNearFork = station.branch == 0 && std::abs(station.place.z() - 15.75) < 0.5;
    if (isNearFork) {
      EXPECT_EQ(station.area.absent, "the cut meets another vessel");
      EXPECT_TRUE(std::isnan(station.area.value));
    }
    empty += !station.area.absent.empty();
    EXPECT_EQ(station.radius.absent, "");  // a sphere is defined everywhere
  }
  EXPECT_LT(empty, m.stations.size() / 4);
  EXPECT_EQ(m.vessels[0].volume.absent, "");
}

TEST(Absent, AreAllMeasuresOfAStubAndOfAnAneurysm) {
  formats::Case value = forkCase();
  formats::Case stub = treeOf({straightTube({0, 0, 0}, {0, 0, 1}, 30, 1.5),
                               childOf(0, 15, {0, 0, 15}, {1.6, 0, 15}, "stub")},
                              0.25);
  const CaseMeasures m = measuresOf(stub);
  EXPECT_EQ(m.vessels[1].length.absent,
            "a stub: it is shorter than its radius beyond its parent's lumen");
  EXPECT_EQ(m.vessels[1].volume.absent, m.vessels[1].length.absent);
  value.tree.branches[1].kind = formats::BranchKind::Aneurysm;
  const CaseMeasures sac = measuresOf(value);
  EXPECT_EQ(sac.vessels[1].length.absent, "an aneurysm is no tube");
  EXPECT_TRUE(sac.forks.empty());
  EXPECT_EQ(sac.paths.size(), 1U);
}

TEST(Absent, AreSectionsOfATreeWithoutModels) {
  const CaseMeasures m = measuresOf(treeOf({straightTube({0, 0, 0}, {0, 0, 1}, 30, 1.5)}, 0.25));
  EXPECT_EQ(m.stations[5].area.absent, "the case has no models: fit it first");
  EXPECT_EQ(m.vessels[0].volume.absent, "the case has no models: fit it first");
  EXPECT_NEAR(m.stations[5].radius.value, 1.5, 1e-6);
  EXPECT_EQ(m.stations[m.stations.size() / 2].torsion.absent,
            "the curvature is not significant: a line has no torsion");
}

TEST(Paths, RunFromTheInletToEachEnd) {
  const formats::Case value = forkCase();
  const CaseMeasures m = measuresOf(value);
  ASSERT_EQ(m.paths.size(), 2U);
  EXPECT_EQ(m.paths[0].branches, std::vector<std::uint32_t>({0}));
  EXPECT_EQ(m.paths[1].branches, std::vector<std::uint32_t>({0, 1}));
  EXPECT_NEAR(m.paths[1].length.value, 15 + std::hypot(12, 6), 0.4);
  EXPECT_NEAR(m.paths[0].length.value, 30, 1e-3);
  EXPECT_NEAR(m.paths[1].takeOff.value, std::atan2(12, 6) * 180 / 3.14159265, 0.5);
  // 0.8 mm is the narrowest: 4.8 French
  EXPECT_NEAR(m.paths[1].catheter.value, 4.8, 0.02);
}

TEST(Tables, AsCsvHaveUnitsIntervalsReasonsAndTheCase) {
  formats::Case value = forkCase();
  const std::vector<MeasureTable> tables = measureTables(value, measuresOf(value));
  ASSERT_EQ(tables.size(), kMeasureKinds);
  const MeasuredCase cases[] = {{"one.lumen", tables}, {"two.lumen", tables}};
  const auto rows = csvRows(measuresCsv(cases, 1), "vessels");
  ASSERT_EQ(rows.size(), 1U + 2 * 2);
  const auto& head = rows[0].cells;
  const auto column = [&](const std::string& name) {
    const auto at = std::find(head.begin(), head.end(), name);
    EXPECT_NE(at, head.end()) << name;
    return static_cast<std::size_t>(at - head.begin());
  };
  for (const auto& row : rows) EXPECT_EQ(row.cells.size(), head.size());
  EXPECT_EQ(rows[1].cells[column("case")], "one.lumen");
  EXPECT_EQ(rows[4].cells[column("case")], "two.lumen");
  EXPECT_EQ(rows[2].cells[column("vessel")], "a, \"b\"");
  EXPECT_NEAR(std::stod(rows[1].cells[column("length_mm")]), 30, 1e-3);
  EXPECT_EQ(rows[1].cells[column("volume_mm3_pm")], "");  // no wall points
  EXPECT_EQ(rows[1].cells[column("absent")], "");
  const auto stations = csvRows(measuresCsv(cases, 0), "stations");
  EXPECT_TRUE(std::any_of(stations.begin(), stations.end(), [](const CsvRow& row) {
    return row.cells.back().find("area_mm2: the cut meets another vessel") != std::string::npos;
  }));
  std::size_t numbers = 0;
  for (const MeasureTable& table : tables) numbers += table.rows.size() * table.values.size();
  EXPECT_EQ(csvRows(measuresLongCsv(cases), "long").size(), 1 + 2 * numbers);
}

// Two cases: one states systems, the other does not.
TEST(Tables, OfVesselsHaveTheirSystem) {
  const formats::Case without = forkCase();
  formats::Case with = without;
  std::vector<formats::VesselSystem> systems;
  for (const std::uint32_t branch : with.tree.branch)
    systems.push_back(branch == 0 ? formats::VesselSystem::Artery : formats::VesselSystem::Vein);
  setNodeSystems(with, systems);
  const MeasuredCase cases[] = {{"a", measureTables(without, measuresOf(without))},
                                {"b", measureTables(with, measuresOf(with))}};
  const auto rows = csvRows(measuresCsv(cases, 1), "vessels");
  ASSERT_EQ(rows.size(), 5U);
  const char* const expected[] = {"system", "", "", "artery", "vein"};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i].cells[2], expected[i]) << i;
  const auto stations = csvRows(measuresCsv(cases, 0), "stations");
  EXPECT_EQ(stations[0].cells[2], "x_mm");
  EXPECT_EQ(csvRows(measuresLongCsv(cases), "long")[0].cells[3], "system");
  EXPECT_EQ(measuresCsv({cases, 1}, 1).find("system"), std::string::npos);
  const auto json = measuresJson(cases[1].tables);
  EXPECT_EQ(json["vessels"][1]["system"], "vein");
  EXPECT_FALSE(json["paths"][0].contains("system"));
  EXPECT_FALSE(measuresJson(cases[0].tables)["vessels"][0].contains("system"));
}

TEST(Tables, AsJsonGiveEveryRowAPlace) {
  Progress progress;
  const auto json = measuresJson(forkCase(), {}, progress);
  EXPECT_EQ(json.size(), kMeasureKinds);
  for (const char* kind : {"stations", "vessels", "paths", "forks"}) {
    ASSERT_FALSE(json[kind].empty()) << kind;
    for (const auto& row : json[kind]) EXPECT_EQ(row["place_mm"].size(), 3U) << kind;
  }
  EXPECT_NEAR(json["forks"][0]["place_mm"][2].get<double>(), 15, 1e-3);
  EXPECT_EQ(json["vessels"][0]["smallest_radius_place_mm"].size(), 3U);
  EXPECT_TRUE(json["vessels"][0]["volume_mm3"]["plus_minus"].is_null());
}

TEST(Changes, AreThoseOfTheVesselsAtOnePlace) {
  const formats::Case before = forkCase();
  // the child comes first, and is wider; a vessel elsewhere has no partner
  Tube child = straightTube({0, 0, 15}, {12, 0, 6}, std::hypot(12, 6), 1);
  child.label = "renamed";
  Tube far = straightTube({50, 0, 0}, {0, 0, 1}, 20, 1);
  far.label = "far";
  Tube trunk = straightTube({0, 0, 0}, {0, 0, 1}, 30, 1.5);
  trunk.label = "trunk";
  const formats::Case after = caseOf({far, child, trunk}, 0.25);
  const auto match = matchBranches(before, after);
  EXPECT_FALSE(match[0]);
  EXPECT_EQ(match[1], 1U);
  EXPECT_EQ(match[2], 0U);
  const auto changes = measureChanges({before, measuresOf(before)}, {after, measuresOf(after)});
  const MeasureTable& vessels = changes[0];
  ASSERT_EQ(vessels.rows.size(), 2U);
  EXPECT_EQ(vessels.rows[0].labels, std::vector<std::string>({"renamed", "a, \"b\""}));
  const auto radius = static_cast<std::size_t>(
      std::find(vessels.values.begin(), vessels.values.end(), "mean_radius_mm") -
      vessels.values.begin());
  EXPECT_NEAR(vessels.rows[0].values[radius].value, 0.2, 2e-3);
  EXPECT_NEAR(vessels.rows[1].values[radius].value, 0, 2e-3);
}

/// The value of a column in the only row of a table.
Measured onlyValue(const std::vector<MeasureTable>& tables, std::string_view kind,
                   std::string_view column) {
  for (const MeasureTable& table : tables) {
    if (table.kind != kind || table.rows.size() != 1) continue;
    for (std::size_t i = 0; i < table.values.size(); ++i)
      if (table.values[i] == column) return table.rows[0].values[i];
  }
  return {};
}

TEST(Changes, IncludePathsAndAneurysms) {
  formats::Case source = caseOf({straightTube({0, 0, 0}, {0, 0, 1}, 30, 1.5)}, 0.25);
  source.tree.branches[0].kind = formats::BranchKind::Aneurysm;
  CaseMeasures before, after;
  before.sacs.emplace_back().width = {5, 0.3, {}};
  after.sacs.emplace_back().width = {5.5, 0.4, {}};
  after.sacs[0].neckDiameter = {3, 0.1, {}};
  before.sacs[0].neckDiameter.absent = "no neck";
  before.paths.emplace_back().length = {30, 1, {}};
  after.paths.emplace_back().length = {29, 0, {}};
  const auto changes = measureChanges({source, before}, {source, after});
  EXPECT_NEAR(onlyValue(changes, "sac_changes", "width_mm").value, 0.5, 1e-12);
  EXPECT_NEAR(onlyValue(changes, "sac_changes", "width_mm").plusMinus, 0.5, 1e-12);
  EXPECT_EQ(onlyValue(changes, "sac_changes", "neck_diameter_mm").absent, "no neck");
  EXPECT_NEAR(onlyValue(changes, "path_changes", "length_mm").value, -1, 1e-12);
}

}  // namespace
}  // namespace lumen::convert::test
