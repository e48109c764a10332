// SPDX-License-Identifier: Apache-2.0
// Seeds in a case.
#include "converters/io/seeds/case_seeds.h"

#include <string>

#include <gtest/gtest.h>

#include "converters/io/seeds/seeds.h"
#include "fixtures.h"
#include "formats/case/case_encoding.h"
#include "formats/case/validate.h"

namespace lumen::convert {
namespace {

/// One node, of the vessel "ica".
formats::Case oneNode() {
  formats::Case value;
  value.tree.centre = {{1, 2, 3}};
  value.tree.direction = {{0, 0, 1}};
  value.tree.radius = {1};
  value.tree.height = {0.5F};
  value.tree.parent = {formats::kNoParent};
  value.tree.branch = {0};
  value.tree.branches.resize(1);
  value.tree.branches[0].label = "ica";
  value.tree.branches[0].nodeCount = 1;
  return value;
}

SeedBranch seed(const std::string& label, const std::optional<std::string>& parent = {}) {
  SeedBranch out;
  out.label = label;
  out.parent = parent;
  out.points.push_back({{0.1, -2.0000000000000004, 1e-17}, 1.5});
  return out;
}

/// A chunk of seeds with that text.
formats::Case withText(const std::string& text) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a")});
  auto& chunk = value.otherChunks.front();
  chunk.bytes.clear();
  for (const char c : text) chunk.bytes.push_back(static_cast<std::byte>(c));
  chunk.rawSize = chunk.bytes.size();
  return value;
}

TEST(CaseSeeds, ACaseWithoutThemHasNone) {
  EXPECT_TRUE(seedsOf(oneNode(), "c").empty());
}

TEST(CaseSeeds, AllOfASeedComesBackFromBothEncodings) {
  formats::Case value = oneNode();
  SeedBranch tracked = seed("ica");
  tracked.isTracked = true;
  tracked.direction = Eigen::Vector3d(0, 0.6, 0.8);
  SeedBranch sac = seed("sac", "ica");
  sac.kind = formats::BranchKind::Aneurysm;
  SeedBranch root = seed("root");
  root.isRoot = true;
  setSeeds(value, {tracked, sac, root});
  ASSERT_TRUE(formats::validate(value));
  const std::vector<std::byte> bytes = formats::encodeBinary(value, {});
  const auto fromBinary = formats::decodeBinary(bytes);
  const auto fromJson = formats::decodeJson(formats::encodeJson(value));
  ASSERT_TRUE(fromBinary && fromJson);
  EXPECT_EQ(formats::encodeBinary(*fromJson, {}), bytes);
  for (const formats::Case& read : {*fromBinary, *fromJson}) {
    const auto seeds = seedsOf(read, "c");
    ASSERT_EQ(seeds.size(), 3U);
    EXPECT_EQ(seeds[0].points[0].position, tracked.points[0].position);
    EXPECT_EQ(seeds[0].points[0].radius, 1.5);
    EXPECT_TRUE(seeds[0].isTracked && !seeds[1].isTracked);
    EXPECT_TRUE(seeds[0].direction->isApprox(*tracked.direction, 1e-15));
    EXPECT_EQ(seeds[1].parent, "ica");
    EXPECT_EQ(seeds[1].kind, formats::BranchKind::Aneurysm);
    EXPECT_TRUE(seeds[2].isRoot);
  }
}

TEST(CaseSeeds, AreReplacedAndRemoved) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a"), seed("b")});
  setSeeds(value, {seed("c")});
  ASSERT_EQ(seedsOf(value, "c").size(), 1U);
  setSeeds(value, {});
  EXPECT_TRUE(value.otherChunks.empty());
}

TEST(CaseSeeds, SurviveAChangeOfTheTree) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a")});
  formats::dropDependentChunks(value);
  EXPECT_EQ(seedsOf(value, "c").size(), 1U);
}

TEST(CaseSeeds, AVesselOfTheCaseIsAParentAndOneThatIsGoneIsNone) {
  formats::Case value = oneNode();
  setSeeds(value, {seed("a", "ica"), seed("b", "gone")});
  const auto seeds = seedsOf(value, "c");
  EXPECT_EQ(seeds[0].parent, "ica");
  EXPECT_FALSE(seeds[1].parent);
  auto file = seeds;
  dropOtherParents(file);
  EXPECT_FALSE(file[0].parent);
}

TEST(CaseSeeds, ThoseThatBreakARuleAreRefusedWithTheirPlace) {
  expectRefused(refusal([] { (void)seedsOf(withText("{}"), "c.lumen"); }),
                {"c.lumen: its seeds", "format"});
  expectRefused(refusal([] { (void)seedsOf(withText(""), "c.lumen"); }), {"c.lumen: its seeds"});
  const std::string cycle =
      R"({"format": "lumen-seeds", "version": 1, "coordinateSystem": "LPS", "units": "mm",
          "branches": [{"label": "a", "parent": "b", "points": [[1, 2, 3]]},
                       {"label": "b", "parent": "a", "points": [[1, 2, 3]]}]})";
  expectRefused(refusal([&] { (void)seedsOf(withText(cycle), "c.lumen"); }), {"its own ancestor"});
  formats::Case other = oneNode();
  setSeeds(other, {seed("a")});
  other.otherChunks[0].version = 2;
  expectRefused(refusal([&] { (void)seedsOf(other, "c.lumen"); }), {"version 2"});
}

TEST(CaseSeeds, SeedsThatStartedNothingWait) {
  formats::Case value = oneNode();
  setSeeds(value, markTracked({seed("a"), seed("b"), seed("c")}, {{"b", "no vessel"}}));
  const SeedCounts counts = countSeeds(value, "c");
  EXPECT_EQ(counts.tracked, 2U);
  EXPECT_EQ(counts.waiting, 1U);
}

// The fiducials of 3D Slicer before version 5.
using Eigen::Vector3d;

const std::string kColumns =
    "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";

class Fcsv : public FileTest {
protected:
  [[nodiscard]] std::vector<SeedBranch> read(const std::string& text,
                                             const SeedReading& reading = {}) const {
    return readSeeds(write("F.fcsv", text), reading);
  }
  [[nodiscard]] std::vector<SeedBranch> readRows(const std::string& rows,
                                                 const std::string& system = "LPS") const {
    return read("# Markups fiducial file version = 4.11\n# CoordinateSystem = " + system + "\n" +
                kColumns + rows);
  }
  void expectRowsRefused(const std::string& rows, std::vector<std::string> words) const {
    words.insert(words.begin(), {"3: ", "F.fcsv"});
    expectRefused(refusal([&] { (void)readRows(rows); }), words);
  }
};

TEST_F(Fcsv, EachRowIsAVessel) {
  const auto seeds = readRows(
      "1,12.5,-3,4e1,0,0,0,1,1,1,0,ICA,,vtkMRMLScalarVolumeNode1,2,0\r\n"
      "2,1,2,3,0,0,0,1,1,1,0,MCA,parent=ICA; radius=1.5,,2,0\r\n");
  ASSERT_EQ(seeds.size(), 2U);
  EXPECT_EQ(seeds[0].label, "ICA");
  EXPECT_EQ(seeds[0].points[0].position, Vector3d(12.5, -3, 40));
  EXPECT_EQ(seeds[1].parent, "ICA");
  EXPECT_EQ(seeds[1].points[0].radius, 1.5);
}

TEST_F(Fcsv, AByteOrderMarkAndTinyNumbersAreRead) {
  const auto seeds = read("\xEF\xBB\xBF# CoordinateSystem = LPS\n" + kColumns +
                          "1,1e-400,-3,4,0,0,0,1,1,1,0,ICA,,\n");
  ASSERT_EQ(seeds.size(), 1U);
  EXPECT_EQ(seeds[0].points[0].position, Vector3d(0, -3, 4));
}

TEST_F(Fcsv, TheHeaderStatesTheCoordinateSystem) {
  const std::string row = "1,1,2,3,0,0,0,1,1,1,0,a,,\n";
  for (const char* lps : {"LPS", "1"})
    EXPECT_EQ(readRows(row, lps)[0].points[0].position, Vector3d(1, 2, 3)) << lps;
  for (const char* ras : {"RAS", "0"})
    EXPECT_EQ(readRows(row, ras)[0].points[0].position, Vector3d(-1, -2, 3)) << ras;
  for (const char* voxels : {"IJK", "2"})
    EXPECT_EQ(readRows(row, voxels)[0].frame.system, SeedSystem::Voxel) << voxels;
  expectRefused(refusal([&] { (void)readRows(row, "MRI"); }),
                {"3: ", "line 2", "\"MRI\"", "LPS", "seeds-frame states another"});
}

TEST_F(Fcsv, WithoutACoordinateSystemAnOptionIsNeeded) {
  const std::string text = "# Fiducial List file\n# columns = label,x,y,z,sel,vis\nP1,1,2,3,1,1\n";
  expectRefused(refusal([&] { (void)read(text); }),
                {"3: ", "F.fcsv", "line 3", "CoordinateSystem", "seeds-frame lps or ras states it",
                 ".mrk.json"});
  const auto seeds = read(text, {SeedSystem::Ras, 10.0});
  EXPECT_EQ(seeds[0].label, "P1");
  EXPECT_EQ(seeds[0].points[0].position, Vector3d(-10, -20, 30));
}

TEST_F(Fcsv, AnOptionOverrulesTheCoordinateSystemOfTheFile) {
  const std::string row = "1,1,2,3,0,0,0,1,1,1,0,a,,\n";
  const std::string lps = "# CoordinateSystem = LPS\n", other = "# CoordinateSystem = MRI\n";
  for (const std::string& header : {lps, other})
    EXPECT_EQ(read(header + kColumns + row, {SeedSystem::Ras, 1.0})[0].points[0].position,
              Vector3d(-1, -2, 3))
        << header;
}

TEST_F(Fcsv, LabelsMayHoldCommasBetweenQuotes) {
  const auto seeds = readRows("1,1,2,3,0,0,0,1,1,1,0,\"ICA, \"\"left\"\"\",,\n");
  EXPECT_EQ(seeds[0].label, "ICA, \"left\"");
}

TEST_F(Fcsv, RowsWithoutALabelAreNumbered) {
  EXPECT_EQ(readRows("1,1,2,3,0,0,0,1,1,1,0,,,\n2,1,2,3\n")[1].label, "F-2");
}

TEST_F(Fcsv, FaultsAreNamedWithLineAndColumn) {
  expectRowsRefused("1,1,nan,3,0,0,0,1,1,1,0,a,,\n", {"line 4", "y is \"nan\"", "finite"});
  expectRowsRefused("1,1,2,,0,0,0,1,1,1,0,a,,\n", {"line 4", "z is \"\"", "finite"});
  expectRowsRefused("1,1e999,2,3,0,0,0,1,1,1,0,a,,\n", {"line 4", "x is \"1e999\""});
  expectRowsRefused("1,1\n", {"line 4", "2 columns", "at least 4"});
  expectRowsRefused("1,1,2,3,0,0,0,1,1,1,0,a,parnt=b,\n", {"line 4", "parnt=b", "parent=LABEL"});
  expectRowsRefused("", {"no seeds"});
  expectRefused(refusal([&] { (void)read("# columns = id,x,y\n1,2,3\n"); }),
                {"line 1", "expected z among them"});
}

TEST_F(Fcsv, OtherTextIsToldWhatSeedsAre) {
  expectRefused(refusal([&] { (void)readSeeds(write("a.csv", "x,y,z\n1,2,3\n")); }),
                {"3: ", "a.csv", "found \"x,y,z\"", ".mrk.json", ".fcsv"});
}

}  // namespace
}  // namespace lumen::convert
