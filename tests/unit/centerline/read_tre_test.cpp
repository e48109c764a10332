// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/centerline/centerline_readers.h"

namespace lumen::convert {
namespace {

const std::string kTube =
    "ObjectType = Scene\nNDims = 3\nNObjects = 1\nObjectType = Tube\nNDims = 3\nID = 4\n"
    "ParentID = -1\nName = ICA\nElementSpacing = 2 1 1\nOffset = 10 0 0\n"
    "TransformMatrix = 0 -1 0 1 0 0 0 0 1\nPointDim = x y z r id\nNPoints = 2\nPoints = \n"
    "1 2 3 0.5 7\n2 2 3 0.25 8\n";

std::string treRefusal(const std::string& text) {
  try {
    parseTre(text, "a.tre");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ReadTre, PlacesAreScaledThenTurnedThenMovedAsItkDoes) {
  const CenterlineFile file = parseTre(kTube, "a.tre");
  ASSERT_EQ(file.points.size(), 2U);
  // (1, 2, 3) * (2, 1, 1) = (2, 2, 3); turned (-2, 2, 3); moved (8, 2, 3)
  EXPECT_EQ(file.points[0].position, Eigen::Vector3d(8, 2, 3));
  EXPECT_EQ(file.points[1].position, Eigen::Vector3d(8, 4, 3));
  EXPECT_EQ(file.points[0].radius, 1.0);
  EXPECT_EQ(file.points[1].parent, 0);
  EXPECT_EQ(file.vessels, std::vector<std::string>{"ICA"});
  EXPECT_EQ(file.unit, 1);
  EXPECT_EQ(file.axes, CenterlineAxes::Lps);
}

TEST(ReadTre, AByteOrderMarkAndTinyNumbersAreRead) {
  const std::string tiny = with(kTube, "2 2 3 0.25", "2 2 1e-400 0.25");
  EXPECT_EQ(parseTre("\xEF\xBB\xBF" + tiny, "a.tre").points.at(1).position.z(), 0);
}

TEST(ReadTre, ATubeHangsOnTheOneThatItsParentIdNames) {
  const std::string text = kTube +
                           "ObjectType = Tube\nID = 5\nParentID = 4\nParentPoint = 1\nPointDim = x "
                           "y z r\nNPoints = 1\nPoints =\n100 100 100 0.1\n";
  const CenterlineFile file = parseTre(text, "a.tre");
  ASSERT_EQ(file.points.size(), 3U);
  EXPECT_EQ(file.points[2].parent, 1);
}

TEST(ReadTre, BinaryPointsAreRead) {
  std::string text =
      with(kTube, "PointDim", "BinaryData = True\nElementType = MET_FLOAT\nPointDim");
  text = text.substr(0, text.find("Points = \n") + 10);
  for (const float value : {1.F, 2.F, 3.F, 0.5F, 7.F, 2.F, 2.F, 3.F, 0.25F, 8.F}) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(bits >> shift & 255);
  }
  const CenterlineFile file = parseTre(text, "a.tre");
  ASSERT_EQ(file.points.size(), 2U);
  EXPECT_EQ(file.points[1].position, Eigen::Vector3d(8, 4, 3));
  EXPECT_EQ(file.points[1].radius, 0.5);
}

TEST(ReadTre, MistakesAreNamedByTheirLine) {
  EXPECT_EQ(treRefusal(""), "a.tre: has no ObjectType; expected a scene of tubes");
  EXPECT_EQ(treRefusal("ObjectType = Scene\n"),
            "a.tre: has no tube with points; expected ObjectType = Tube");
  EXPECT_EQ(treRefusal("hello\n"), "a.tre: line 1 is \"hello\"; expected KEY = VALUE");
  EXPECT_EQ(treRefusal(with(kTube, "1 2 3 0.5 7", "1 2 x 0.5 7")),
            "a.tre: line 15 has \"x\"; expected a number");
  EXPECT_EQ(treRefusal(with(kTube, "1 2 3 0.5 7", "1 2 3 0.5 7 9")),
            "a.tre: line 15 has 6 numbers; expected 5, as PointDim");
  EXPECT_EQ(treRefusal(with(kTube, "NPoints = 2", "NPoints = 2000000000")),
            "a.tre: line 14 begins 2000000000 points of 5 numbers, more than the file holds");
  EXPECT_EQ(treRefusal(with(kTube, "NPoints = 2", "NPoints = 3")),
            "a.tre: line 16 is the last, but points are missing");
  EXPECT_EQ(treRefusal(with(kTube, "PointDim = x y z r id", "PointDim = x y r id q")),
            "a.tre: line 14 begins points without the column z in PointDim");
  EXPECT_EQ(treRefusal(with(kTube, "PointDim = x y z r id", "PointDim = x y z v id")),
            "a.tre: has no radius at any point of it; expected the column r of PointDim");
  EXPECT_EQ(treRefusal(with(kTube, "1 2 3 0.5 7", "1 2 inf 0.5 7")),
            "a.tre: line 15 has the number inf; expected -1e9 to 1e9");
}

}  // namespace
}  // namespace lumen::convert
