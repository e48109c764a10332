// SPDX-License-Identifier: Apache-2.0
// 3D Slicer Markups as seeds.
#include <algorithm>

#include <gtest/gtest.h>

#include "converters/io/seeds/seeds.h"
#include "fixtures.h"
#include "tests/unit/formats/json_samples.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::BranchKind;

class Markups : public FileTest {
protected:
  std::filesystem::path file(const std::string& markups) const {
    return write("Left ICA.mrk.json",
                 R"({"@schema": "markups-schema-v1.0.3.json#", "markups": [)" + markups + "]}");
  }
  [[nodiscard]] std::vector<SeedBranch> read(const std::string& markups) const {
    return readSeeds(file(markups));
  }
  void expectMarkupsRefused(const std::string& markups, std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "Left ICA.mrk.json"});
    expectRefused(refusal([&] { (void)read(markups); }), words);
  }
};

std::string point(const std::string& label, const std::string& position,
                  const std::string& more = "") {
  return R"({"id": "1", "label": ")" + label + R"(", "position": )" + position + more + "}";
}

std::string markup(const std::string& type, const std::string& points,
                   const std::string& more = "") {
  return R"({"type": ")" + type +
         R"(", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": [)" + points +
         "]" + more + "}";
}

TEST_F(Markups, EachFiducialPointIsABranch) {
  const auto seeds =
      read(markup("Fiducial", point("ICA", "[1, 2, 3]") + "," + point("MCA", "[4, 5, 6]")));
  ASSERT_EQ(seeds.size(), 2U);
  EXPECT_EQ(seeds[0].label, "ICA");
  EXPECT_EQ(seeds[1].label, "MCA");
  EXPECT_EQ(seeds[1].points[0].position, Vector3d(4, 5, 6));
  EXPECT_EQ(seeds[1].points.size(), 1U);
}

TEST_F(Markups, NumbersOfEveryWriterAreTheNearestDouble) {
  const auto samples = lumen::test::jsonSamples(1e6);
  std::string points;
  for (const auto& sample : samples)
    points +=
        (points.empty() ? "" : ",") +
        point("", "[" + sample.text + ", " + std::to_string(&sample - samples.data()) + ", 0]");
  const auto seeds = read(markup("Curve", points));
  ASSERT_EQ(seeds[0].points.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    EXPECT_EQ(seeds[0].points[i].position.x(), samples[i].value) << samples[i].text;
}

TEST_F(Markups, CurveIsOneBranchNamedAfterTheFile) {
  const auto seeds =
      read(markup("Curve", point("x-1", "[1, 2, 3]") + "," + point("x-2", "[4, 5, 6]")));
  ASSERT_EQ(seeds.size(), 1U);
  EXPECT_EQ(seeds[0].label, "Left ICA");
  EXPECT_EQ(seeds[0].points.size(), 2U);
  EXPECT_EQ(seeds[0].points[1].position, Vector3d(4, 5, 6));
}

TEST_F(Markups, NameOfAMarkupIsItsLabel) {
  const auto seeds = read(
      markup("Line", point("", "[1, 2, 3]") + "," + point("", "[4, 5, 6]"), R"(, "name": "L")") +
      "," + markup("ClosedCurve", point("", "[1, 2, 3]"), R"(, "name": "C")"));
  ASSERT_EQ(seeds.size(), 2U);
  EXPECT_EQ(seeds[0].label, "L");
  EXPECT_EQ(seeds[1].label, "C");
}

TEST_F(Markups, RasIsTurnedIntoLps) {
  for (const char* ras : {"\"RAS\"", "\"0\"", "0"}) {
    const auto seeds = read(R"({"type": "Fiducial", "coordinateSystem": )" + std::string(ras) +
                            R"(, "controlPoints": [)" + point("a", "[1, 2, 3]") + "]}");
    EXPECT_EQ(seeds[0].points[0].position, Vector3d(-1, -2, 3)) << ras;
  }
}

TEST_F(Markups, LpsIsTheDefaultAndMayBeANumber) {
  for (const char* lps : {"", R"("coordinateSystem": "LPS",)", R"("coordinateSystem": 1,)"}) {
    const auto seeds = read(R"({"type": "Fiducial", )" + std::string(lps) +
                            R"("controlPoints": [)" + point("a", "[1, 2, 3]") + "]}");
    EXPECT_EQ(seeds[0].points[0].position, Vector3d(1, 2, 3)) << lps;
  }
}

TEST_F(Markups, UnknownCoordinateSystemIsRefused) {
  expectMarkupsRefused(R"({"type": "Fiducial", "coordinateSystem": 2, "controlPoints": []})",
                       {"/markups/0/coordinateSystem", "found 2", "RAS"});
}

TEST_F(Markups, CodedUnitsCountByTheirFirstWord) {
  const auto seeds =
      read(R"({"type": "Fiducial", "coordinateUnits": ["m", "UCUM", "meter"], "controlPoints": [)" +
           point("a", "[0.001, 0, 0]") + "]}");
  EXPECT_DOUBLE_EQ(seeds[0].points[0].position.x(), 1);
}

TEST_F(Markups, UnknownUnitIsRefused) {
  expectMarkupsRefused(R"({"type": "Fiducial", "coordinateUnits": "fathoms", "controlPoints": []})",
                       {"/markups/0/coordinateUnits", "\"fathoms\"", "\"mm\""});
}

TEST_F(Markups, RadiusMeasurementGivesThePointsTheirRadii) {
  const auto seeds = read(markup("Curve", point("", "[1, 2, 3]") + "," + point("", "[4, 5, 6]"),
                                 R"(, "measurements": [{"name": "length", "enabled": false},
                                     {"name": "Radius", "enabled": true, "controlPointValues": [2.5, 1.5]}])"));
  EXPECT_EQ(seeds[0].points[0].radius, 2.5);
  EXPECT_EQ(seeds[0].points[1].radius, 1.5);
}

TEST_F(Markups, RadiusMeasurementMayHaveUnitsOfItsOwn) {
  const auto seeds = read(markup("Curve", point("", "[1, 2, 3]") + "," + point("", "[4, 5, 6]"),
                                 R"(, "measurements": [{"name": "Radius", "units": "cm",
                                     "controlPointValues": [0.25, 0.15]}])"));
  EXPECT_EQ(seeds[0].points[0].radius, 2.5);
  EXPECT_EQ(seeds[0].points[0].position.x(), 1);
}

TEST_F(Markups, RadiusMeasurementOfAnotherLengthIsRefused) {
  expectMarkupsRefused(
      markup("Curve", point("", "[1, 2, 3]") + "," + point("", "[4, 5, 6]"),
             R"(, "measurements": [{"name": "radius", "controlPointValues": [2.5]}])"),
      {"/markups/0/measurements/0/controlPointValues", "2 radii"});
}

TEST_F(Markups, RadiusThatIsNotPositiveIsRefused) {
  expectMarkupsRefused(
      markup("Curve", point("", "[1, 2, 3]"),
             R"(, "measurements": [{"name": "Radius", "controlPointValues": [0]}])"),
      {"\"Left ICA\"", "radius 0", "positive"});
}

TEST_F(Markups, PointsThatAreNotPlacedAreSkipped) {
  const auto seeds = read(markup(
      "Curve",
      point("", "[1, 2, 3]") + "," + point("", "[0, 0, 0]", R"(, "positionStatus": "undefined")") +
          "," + point("", "[4, 5, 6]", R"(, "positionStatus": "defined")"),
      R"(, "measurements": [{"name": "Radius", "controlPointValues": [1, 2, 3]}])"));
  ASSERT_EQ(seeds[0].points.size(), 2U);
  EXPECT_EQ(seeds[0].points[1].position, Vector3d(4, 5, 6));
  EXPECT_EQ(seeds[0].points[1].radius, 3);
}

TEST_F(Markups, DescriptionGivesParentKindAndRadius) {
  const auto seeds = read(markup(
      "Fiducial", point("sac", "[4, 5, 6]",
                        R"(, "description": "the dome; parent = ICA; kind=aneurysm; radius=2.5")") +
                      "," + point("ICA", "[1, 2, 3]", R"(, "description": "first guess")")));
  ASSERT_EQ(seeds.size(), 2U);
  EXPECT_EQ(seeds[0].label, "ICA");
  EXPECT_EQ(seeds[1].label, "sac");
  EXPECT_EQ(seeds[1].parent, "ICA");
  EXPECT_EQ(seeds[1].kind, BranchKind::Aneurysm);
  EXPECT_EQ(seeds[1].points[0].radius, 2.5);
}

TEST_F(Markups, DescriptionOfACurveIsThatOfItsFirstPoint) {
  const auto seeds =
      read(markup("Fiducial", point("ICA", "[1, 2, 3]")) + "," +
           markup("Curve", point("", "[4, 5, 6]", R"(, "description": "parent=ICA")") + "," +
                               point("", "[7, 8, 9]")));
  EXPECT_EQ(seeds[1].parent, "ICA");
}

TEST_F(Markups, UnknownWordBeforeAnEqualsSignIsRefused) {
  expectMarkupsRefused(
      markup("Fiducial", point("a", "[4, 5, 6]", R"(, "description": "parnt=ICA")")),
      {"/markups/0/controlPoints/0/description", "parent=LABEL"});
}

TEST_F(Markups, DuplicateLabelIsRefused) {
  expectMarkupsRefused(markup("Fiducial", point("a", "[1, 2, 3]") + "," + point("a", "[4, 5, 6]")),
                       {"\"a\"", "number 1 and 2", "this label"});
}

TEST_F(Markups, OtherTypesAreRefused) {
  expectMarkupsRefused(markup("Plane", point("a", "[1, 2, 3]")),
                       {"/markups/0/type", "\"Plane\"", "Curve"});
}

TEST_F(Markups, FileWithoutAPlacedPointIsRefused) {
  expectMarkupsRefused(markup("Fiducial", ""), {"no seeds"});
  expectMarkupsRefused(markup("Curve", ""), {"\"Left ICA\"", "no points"});
}

TEST_F(Markups, AreKnownByTheirContentNotTheirName) {
  const auto seeds = readSeeds(
      write("any.json", R"({"markups": [)" + markup("Curve", point("", "[1, 2, 3]")) + "]}"));
  EXPECT_EQ(seeds[0].label, "any");
}

TEST_F(Markups, AreWrittenAsTheyAreRead) {
  SeedBranch trunk, sac, click;
  trunk.label = "ICA \"left\"";
  trunk.points = {{{1.1, -2.2, 3.3}, 2.5}, {{4, 5, 6}, 2.25}};
  sac.label = "sac";
  sac.kind = BranchKind::Aneurysm;
  sac.parent = trunk.label;
  sac.points = {{{2, 3, 4}, 3.0}, {{3, 4, 5}, 4.0}};
  click.label = "PComA";
  click.parent = trunk.label;
  click.points = {{{7, 8, 9}, 0.75}};
  const auto out = write("out.mrk.json", "");
  writeSeeds({trunk, sac, click}, out);
  const auto seeds = readSeeds(out);
  ASSERT_EQ(seeds.size(), 3U);
  for (const SeedBranch& wanted : {trunk, sac, click}) {
    const auto found = std::find_if(seeds.begin(), seeds.end(),
                                    [&](const SeedBranch& s) { return s.label == wanted.label; });
    ASSERT_NE(found, seeds.end()) << wanted.label;
    EXPECT_EQ(found->kind, wanted.kind);
    EXPECT_EQ(found->parent, wanted.parent);
    ASSERT_EQ(found->points.size(), wanted.points.size());
    for (std::size_t i = 0; i < wanted.points.size(); ++i) {
      EXPECT_EQ(found->points[i].position, wanted.points[i].position);
      EXPECT_EQ(found->points[i].radius, wanted.points[i].radius);
    }
  }
}

TEST_F(Markups, RealCenterlinesAreRead) {
  const std::filesystem::path folder = LUMEN_SHARED_DATA "/neurovascular/centerlines";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    const auto seeds = readSeeds(entry.path());
    ASSERT_EQ(seeds.size(), 1U);
    EXPECT_EQ(seeds[0].label + ".mrk.json", entry.path().filename());
    EXPECT_GE(seeds[0].points.size(), 5U);
    for (const auto& p : seeds[0].points)
      EXPECT_TRUE(p.radius && *p.radius > 0.2 && *p.radius < 20);
    ++files;
  }
  EXPECT_EQ(files, 25);
}

}  // namespace
}  // namespace lumen::convert
