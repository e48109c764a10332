// SPDX-License-Identifier: Apache-2.0
// Lines of VTK as other programs cut, turn and connect them: one tree of two or three vessels.
#include "converters/io/centerline/line_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "line_files.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using test::LineFile;

const Vector3d kInlet(0, 0, 0), kThinTip(-9, 0, 32);

CenterlineFile read(const LineFile& file, const std::string& cells = "") {
  return parseVtpCenterline(test::vtpOf(file, "", "", cells), "t.vtp");
}

/// Expects the fork of test::fork(), and returns the number of remarks.
std::size_t expectFork(const CenterlineFile& file, const char* what) {
  EXPECT_EQ(test::rootsOf(file), std::vector<Vector3d>{kInlet}) << what;
  EXPECT_NEAR(test::lengthOf(file), 50, 1e-6) << what;
  const std::size_t chains = centerlineChains(file).size();
  EXPECT_TRUE(chains == 2 || chains == 3) << what << ": " << chains;
  CenterlineFile inMm = file;
  toPatientSpace(inMm, {1.0, CenterlineAxes::Lps});
  double length = 0;
  const formats::Case value = caseOfCenterline(inMm, "t");
  for (std::size_t n = 0; n < value.tree.nodeCount(); ++n)
    if (value.tree.parent[n] >= 0) {
      const auto& a = value.tree.centre[n];
      const auto& b = value.tree.centre[std::size_t(value.tree.parent[n])];
      length += (Vector3d(a.x, a.y, a.z) - Vector3d(b.x, b.y, b.z)).norm();
    }
  EXPECT_NEAR(length, 50, 1) << what;
  return file.remarks.size();
}

TEST(LineGraph, CellsOfTwoPointsAreOneForkWithoutARemark) {
  EXPECT_EQ(expectFork(read(test::fork()), "as drawn"), 0U);
}

TEST(LineGraph, EveryTurnedCellIsTurnedBackWithARemark) {
  for (std::size_t cell = 0; cell < 50; cell += 7) {
    LineFile file = test::fork();
    std::reverse(file.lines[cell].begin(), file.lines[cell].end());
    const CenterlineFile found = read(file);
    EXPECT_EQ(expectFork(found, "one turned"), 1U) << cell;
    EXPECT_EQ(found.remarks.at(0), "1 of its 50 lines runs towards the root, and is turned");
  }
}

TEST(LineGraph, CellsThatAllRunToTheRootAreTurned) {
  LineFile file = test::fork();
  for (auto& line : file.lines) std::reverse(line.begin(), line.end());
  EXPECT_EQ(expectFork(read(file), "all turned"), 2U);
}

TEST(LineGraph, CellsOfAnyDirectionBeginAtTheWidestEnd) {
  LineFile file = test::fork();
  for (std::size_t i = 0; i < file.lines.size(); i += 2)
    std::reverse(file.lines[i].begin(), file.lines[i].end());
  expectFork(read(file), "every other turned");
  expectFork(read(test::unshared(file)), "every other turned, unshared");
}

TEST(LineGraph, CellsInAnyOrderAreTheSameFork) {
  LineFile file = test::fork();
  std::rotate(file.lines.begin(), file.lines.begin() + 17, file.lines.end());
  std::reverse(file.lines.begin() + 5, file.lines.end());
  EXPECT_EQ(expectFork(read(file), "shuffled"), 0U);
}

TEST(LineGraph, PointsOfTheirOwnAtEqualPlacesAreOne) {
  EXPECT_EQ(expectFork(read(test::unshared(test::fork())), "unshared"), 1U);
  LineFile rounded = test::unshared(test::fork());
  for (std::size_t i = 0; i < rounded.points.size(); i += 2)
    rounded.points[i].y() += 1e-6;  // as floats of far coordinates are rounded
  const CenterlineFile file = parseVtpCenterline(test::vtpOf(rounded), "t.vtp");
  EXPECT_EQ(test::rootsOf(file).size(), 1U);
  EXPECT_NEAR(test::lengthOf(file), 50, 1e-3);
}

TEST(LineGraph, PiecesOfSeveralPointsAreOneFork) {
  LineFile file = test::fork();
  for (const std::size_t size : {2U, 4U, 5U}) {  // cells of the trunk and of each arm per piece
    LineFile pieces = file;
    pieces.lines.clear();
    for (const auto& [first, count] :
         std::vector<std::pair<std::size_t, std::size_t>>{{0, 20}, {20, 15}, {35, 15}})
      for (std::size_t c = 0; c < count; c += size) {
        std::vector<int>& line = pieces.lines.emplace_back(file.lines[first + c]);
        for (std::size_t k = 1; k < size && c + k < count; ++k)
          line.push_back(file.lines[first + c + k].back());
      }
    for (std::size_t i = 0; i < pieces.lines.size(); i += 3)
      std::reverse(pieces.lines[i].begin(), pieces.lines[i].end());
    expectFork(read(pieces), "pieces");
    expectFork(read(test::unshared(pieces)), "pieces, unshared");
  }
}

TEST(LineGraph, ATriangleAtAForkKeepsOneLink) {
  LineFile file = test::fork();
  file.lines.push_back({21, 36});  // the first points of both arms
  const CenterlineFile found = read(file);
  EXPECT_EQ(expectFork(found, "triangle"), 1U);
  EXPECT_EQ(found.links.size(), 1U);
  file.lines.back() = {36, 19};  // an arm and the trunk
  EXPECT_EQ(read(file).links.size(), 1U);
}

TEST(LineGraph, ARingIsOneTreeWithOneLink) {
  LineFile ring;
  for (int i = 0; i < 40; ++i)
    ring.add(
        10 * Vector3d(std::cos(i * std::numbers::pi / 20), std::sin(i * std::numbers::pi / 20), 0),
        1);
  for (int i = 0; i < 40; ++i) ring.lines.push_back({i, (i + 1) % 40});
  const CenterlineFile found = read(ring);
  EXPECT_EQ(test::rootsOf(found).size(), 1U);
  EXPECT_EQ(found.points.size(), 40U);
  EXPECT_EQ(found.links.size(), 1U);
}

TEST(LineGraph, LinesThatShareSomeIndicesAndSomePlacesAreOneFork) {
  const LineFile cells = test::fork();
  LineFile mixed = cells;
  mixed.lines.assign(3, {0});
  for (int i = 1; i <= 20; ++i) mixed.lines[0].push_back(i);
  mixed.lines[1] = {20};
  for (int i = 21; i <= 35; ++i) mixed.lines[1].push_back(i);
  mixed.lines[2] = {mixed.add(cells.points[20], 1.2)};  // another point at the fork
  for (int i = 36; i <= 50; ++i) mixed.lines[2].push_back(i);
  EXPECT_EQ(expectFork(read(mixed), "mixed"), 1U);
}

TEST(LineGraph, CellsWithoutLengthAreDropped) {
  LineFile file = test::unshared(test::fork());
  file.lines.push_back({0});
  file.lines.push_back({40});
  file.lines.push_back({60, 60});
  EXPECT_EQ(expectFork(read(file), "degenerate"), 2U);
}

TEST(LineGraph, ANetworkBeginsAtItsWidestEnd) {
  const LineFile cells = test::fork();
  // bit n of `turns`: line n runs towards the fork's other side
  for (int turns = 0; turns < 8; ++turns) {
    LineFile network = cells;
    network.lines.assign(3, {});
    for (int i = 0; i <= 20; ++i) network.lines[0].push_back(i);
    for (int i = 20; i <= 35; ++i) network.lines[1].push_back(i);
    network.lines[2].push_back(20);
    for (int i = 36; i <= 50; ++i) network.lines[2].push_back(i);
    for (std::size_t n = 0; n < 3; ++n)
      if (turns >> n & 1) std::reverse(network.lines[n].begin(), network.lines[n].end());
    expectFork(read(network), "network");
    expectFork(read(test::unshared(network)), "network, unshared");
    expectFork(read(network, test::array("Int64", "Topology", 2, "0 1 1 2 1 3")), "VMTK's");
  }
}

TEST(LineGraph, DirectionsThatAgreeCountMoreThanALittleWidth) {
  LineFile file = test::fork();
  file.radii[35] = 2.3;  // an aneurysm at a tip
  EXPECT_EQ(expectFork(read(file), "wide tip"), 0U);
}

TEST(LineGraph, LinesFromTipsToARootThatTheyShareAreTurned) {
  LineFile lines;
  for (const double side : {0.6, -0.6}) {
    std::vector<int>& line = lines.lines.emplace_back();
    for (int i = 15; i > 0; --i)
      line.push_back(lines.add(Vector3d(side * i, 0, 20 + 0.8 * i), 1.3));
    for (int i = 20; i >= 0; --i) line.push_back(lines.add(Vector3d(0, 0, i), 2));
  }
  expectFork(read(lines), "tip to root");
}

TEST(LineGraph, NumbersOfBranchesStay) {
  LineFile file = test::fork();
  std::string branches;
  for (std::size_t i = 0; i < file.points.size(); ++i)
    branches += i <= 20 ? "7 " : i <= 35 ? "8 " : "9 ";
  const std::string array = test::array("Int32", "Branch", 1, branches);
  for (const bool isTurned : {false, true}) {
    if (isTurned) std::swap(file.lines[4][0], file.lines[4][1]);
    if (isTurned) file.lines.push_back({21, 36});  // a triangle
    const CenterlineFile found = parseVtpCenterline(test::vtpOf(file, "", array), "t");
    EXPECT_EQ(found.vessels.size(), 3U);
    EXPECT_EQ(centerlineChains(found).size(), 3U);
    EXPECT_EQ(caseOfCenterline(found, "t").tree.branches.size(), 3U);
  }
}

/// Lines from the root to both tips, whose trunks have points of their own, off by `off`.
LineFile twoWays(double off, bool isTurned) {
  LineFile lines;
  for (const double side : {0.6, -0.6}) {
    std::vector<int>& line = lines.lines.emplace_back();
    line.push_back(lines.add(kInlet, 2));
    const double start = side > 0 ? 1 : 0.5;  // sampled anew
    for (double z = start; z < 20; z += 1) line.push_back(lines.add({off * side, 0, z}, 2));
    for (int i = 0; i <= 15; ++i) line.push_back(lines.add({side * i, 0, 20 + 0.8 * i}, 1.3));
    if (isTurned) std::reverse(line.begin(), line.end());
  }
  return lines;
}

TEST(LineGraph, LinesToEachTipWithTrunksOfTheirOwnShareTheTrunk) {
  for (const double off : {0.0, 0.05, 0.1}) {
    const CenterlineFile file = read(twoWays(off, false));
    EXPECT_EQ(test::rootsOf(file), std::vector<Vector3d>{kInlet}) << off;
    EXPECT_NEAR(test::lengthOf(file), 50, 1) << off;
    EXPECT_TRUE(file.remarks.empty()) << off;
    const CenterlineFile turned = read(twoWays(off, true));
    EXPECT_EQ(test::rootsOf(turned), std::vector<Vector3d>{kInlet}) << off;
    EXPECT_NEAR(test::lengthOf(turned), 50, 1) << off;
    EXPECT_EQ(turned.remarks.size(), 2U) << off;
  }
}

TEST(LineGraph, TwoVesselsThatBeginAtOnePlaceBeginThere) {
  LineFile lines;
  for (const double side : {1.0, -1.0}) {
    std::vector<int>& line = lines.lines.emplace_back();
    for (int i = 0; i <= 20; ++i) line.push_back(lines.add({side * i, 0, 0.2 * i}, 1.5));
  }
  const CenterlineFile file = read(lines);
  EXPECT_EQ(test::rootsOf(file), std::vector<Vector3d>{kInlet});
  EXPECT_EQ(centerlineChains(file).size(), 2U);
  EXPECT_TRUE(file.remarks.empty());
}

TEST(LineGraph, PartsApartStayTrees) {
  LineFile file = test::fork();
  const LineFile other = test::fork();
  for (std::size_t i = 0; i < other.lines.size(); ++i) {
    const Vector3d away(40, 0, 0);
    const auto at = [&](int end) {
      return other.points[std::size_t(other.lines[i][std::size_t(end)])];
    };
    file.lines.push_back({file.add(at(0) + away, 1), file.add(at(1) + away, 1)});
  }
  const CenterlineFile found = read(file);
  EXPECT_EQ(test::rootsOf(found).size(), 2U);
  EXPECT_NEAR(test::lengthOf(found), 100, 1e-6);
}

TEST(LineGraph, APartThatBeginsInTheLumenOfAnotherIsAttached) {
  LineFile file = test::fork();
  std::reverse(file.lines[3].begin(), file.lines[3].end());  // the graph decides
  int last = file.add({0.5, 1, 10}, 0.8);
  for (int i = 1; i <= 10; ++i) {
    const int next = file.add({0.5, 1.0 + i, 10}, 0.8);
    file.lines.push_back({last, next});
    last = next;
  }
  const CenterlineFile found = read(file);
  EXPECT_EQ(test::rootsOf(found), std::vector<Vector3d>{kInlet});
  EXPECT_EQ(found.points.size(), 62U);
}

TEST(LineGraph, TenThousandsOfCellsAreRead) {
  LineFile file;
  int last = file.add({0, 0, 0}, 2);
  for (int i = 1; i < 25000; ++i) {
    file.lines.push_back({last, file.add({0, 0, 0.1 * i}, 2)});
    last = file.lines.back()[1];
  }
  const CenterlineFile found = read(test::unshared(file));
  EXPECT_EQ(test::rootsOf(found).size(), 1U);
  EXPECT_EQ(centerlineChains(found).size(), 1U);
}

TEST(LineGraph, LinesWithoutLengthAloneAreRefused) {
  LineFile file = test::fork();
  for (Vector3d& p : file.points) p.setZero();
  try {
    parseVtpCenterline(test::vtpOf(file), "t.vtp");
    FAIL() << "a file without a line of any length is read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("at one place each"), std::string::npos);
  }
}

TEST(LegacyLines, TextAndBytesOfAllVersionsAreTheSameFork) {
  for (const bool isBinary : {false, true})
    for (const bool hasOffsets : {false, true}) {
      const CenterlineFile file =
          parseVtkCenterline(test::legacyOf(test::fork(), isBinary, hasOffsets), "t.vtk");
      EXPECT_EQ(expectFork(file, "legacy"), 0U);
      EXPECT_EQ(file.axes, CenterlineAxes::Unknown);
    }
  EXPECT_EQ(parseVtkCenterline(
                test::legacyOf(test::fork(), false, false, "3D Slicer output. SPACE=RAS"), "t")
                .axes,
            CenterlineAxes::Ras);
}

TEST(LegacyLines, PointsAndRadiiThatAreNotThereAreRefused) {
  LineFile file = test::fork();
  file.lines.push_back({3, 99});
  EXPECT_THROW(parseVtkCenterline(test::legacyOf(file, false, false), "t"), Error);
  LineFile fewer = test::fork();
  fewer.radii.pop_back();
  EXPECT_THROW(parseVtkCenterline(test::legacyOf(fewer, false, false), "t"), Error);
}

// "RAS" and "cm" with a zero behind, as characters and in base64 behind their size
const char* const kTexts[] = {
    "<Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">82 65 83 0</Array>"
    "<Array type=\"String\" Name=\"Unit\" NumberOfTuples=\"1\" format=\"ascii\">99 109 0</Array>",
    "<Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" "
    "format=\"binary\">BAAAAFJBUwA=</Array>"
    "<Array type=\"String\" Name=\"Unit\" NumberOfTuples=\"1\" "
    "format=\"binary\">AwAAAGNtAA==</Array>",
    "<DataArray type=\"String\" Name=\"SPACE\" format=\"ascii\">82 65 83 0</DataArray>"
    "<DataArray type=\"String\" Name=\"Unit\" format=\"ascii\">99 109 0</DataArray>"};

TEST(VtpLines, AxesAndUnitAreThoseOfTheFieldData) {
  for (const char* const field : kTexts) {
    CenterlineFile file = parseVtpCenterline(
        test::vtpOf(test::fork(), std::string("<FieldData>") + field + "</FieldData>"), "t");
    EXPECT_EQ(file.axes, CenterlineAxes::Ras);
    EXPECT_EQ(file.unit, 10);
    const ReadFrame frame = toPatientSpace(file, {});
    EXPECT_EQ(frame.unitFrom, "file");
    EXPECT_TRUE(frame.frameStated);
    EXPECT_EQ(file.points.back().position, Vector3d(90, 0, 320));  // of (-9, 0, 32) cm
    EXPECT_EQ(file.remarks,
              std::vector<std::string>{"the file states RAS: x and y were negated, to LPS"});
  }
}

TEST(VtpLines, CenterlinesOfSimVascularAreInCentimetresIfThatIsPlausible) {
  LineFile file = test::fork();
  for (Vector3d& p : file.points) p *= 0.6;
  for (double& radius : file.radii) radius *= 0.6;
  std::string ids;
  for (std::size_t i = 0; i < file.points.size(); ++i) ids += "0 ";
  const auto unitOf = [&](const std::string& arrays, std::size_t remarks) {
    CenterlineFile read = parseVtpCenterline(test::vtpOf(file, "", arrays), "t");
    const ReadFrame frame = toPatientSpace(read, {});
    EXPECT_EQ(frame.unitFrom, "guess");
    EXPECT_EQ(read.remarks.size(), remarks);
    return frame.unit;
  };
  EXPECT_EQ(unitOf(test::array("Int64", "BranchId", 1, ids), 1), 10);
  EXPECT_EQ(unitOf("", 1), 1);  // a remark states that cm is plausible, too
}

TEST(LineGraph, APlaceThatIsNoNumberIsRefusedOnEveryAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    LineFile file = test::fork();
    file.points[4][axis] = std::numeric_limits<double>::quiet_NaN();
    try {
      parseVtkCenterline(test::legacyOf(file, true, true), "t.vtk");
      ADD_FAILURE() << axis;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("point 4 is not finite"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace lumen::convert
