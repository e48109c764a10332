// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/centerline/centerline_readers.h"

namespace lumen::convert {
namespace {

// The message of the refusal, or "" if the text is read.
std::string refusal(const std::string& text) {
  try {
    parseSwc(text, "tree.swc");
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
}

TEST(ReadSwc, APointHasItsPositionRadiusTypeAndParent) {
  const CenterlineFile file = parseSwc("1 1 0.5 -2 3e1 4 -1\n2 3 1 2 3 .25 1\n", "tree.swc");
  ASSERT_EQ(file.points.size(), 2U);
  EXPECT_EQ(file.points[0].position, Eigen::Vector3d(0.5, -2, 30));
  EXPECT_EQ(file.points[0].radius, 4);
  EXPECT_EQ(file.points[0].type, 1);
  EXPECT_EQ(file.points[0].parent, kNoPoint);
  EXPECT_EQ(file.points[1].radius, 0.25);
  EXPECT_EQ(file.points[1].type, 3);
  EXPECT_EQ(file.points[1].parent, 0);
}

TEST(ReadSwc, CommentsBlankLinesTabsAndFurtherColumnsAreNoPoints) {
  const CenterlineFile file = parseSwc(
      "# ORIGINAL_SOURCE NeuroMorpho\n##n,type,x,y,z,radius,parent\n\n  \t\n"
      "\t1\t2 0 0 0 1  -1   0 17 abc\n2 2 1 0 0 1 1 # a remark",
      "tree.swc");
  EXPECT_EQ(file.points.size(), 2U);
}

TEST(ReadSwc, LinesEndInEveryWay) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text =
        "# head" + end + "1 0 0 0 0 1 -1" + end + end + "2 0 1 0 0 1 1" + end + "3 0 2 0 0 x 2";
    EXPECT_NE(refusal(text).find("line 5: the radius is \"x\""), std::string::npos)
        << refusal(text);
  }
}

TEST(ReadSwc, AByteOrderMarkAndIdsWrittenAsRealNumbersAreRead) {
  const CenterlineFile file = parseSwc(
      "\xEF\xBB\xBF"
      "1.000e+00 0.0 0 0 0 1 -1.0\n2.0 0 1 0 0 +1 1.0",
      "tree.swc");
  EXPECT_EQ(file.points[1].parent, 0);
  EXPECT_EQ(file.points[1].radius, 1);
}

TEST(ReadSwc, NumbersTooSmallForADoubleAreZero) {
  EXPECT_EQ(parseSwc("1 1 1e-400 0 0 1 -1\n", "tree.swc").points[0].position.x(), 0);
  EXPECT_NE(refusal("1 1 1e400 0 0 1 -1\n"), "");
}

TEST(ReadSwc, ParentsComeFirstWhereverTheyStandAndWhateverTheirIds) {
  // 70 <- 5 <- 900, and a root of its own in between
  const CenterlineFile file =
      parseSwc("900 0 3 0 0 1 5\n70 0 1 0 0 1 -1\n8 0 9 0 0 1 -1\n5 0 2 0 0 1 70\n", "tree.swc");
  ASSERT_EQ(file.points.size(), 4U);
  EXPECT_EQ(file.points[0].position.x(), 1);
  EXPECT_EQ(file.points[1].position.x(), 9);
  EXPECT_EQ(file.points[2].position.x(), 2);
  EXPECT_EQ(file.points[3].position.x(), 3);
  EXPECT_EQ(file.points[1].parent, kNoPoint);
  EXPECT_EQ(file.points[2].parent, 0);
  EXPECT_EQ(file.points[3].parent, 2);
}

TEST(ReadSwc, PointsKeepTheOrderOfTheFileWhereParentsComeFirst) {
  const CenterlineFile file = parseSwc(
      "1 0 1 0 0 1 -1\n2 0 2 0 0 1 1\n3 0 3 0 0 1 1\n4 0 4 0 0 1 2\n5 0 5 0 0 1 3\n", "tree.swc");
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(file.points[i].position.x(), static_cast<double>(i) + 1);
}

struct Refused {
  const char* text;
  const char* message;
};

class ReadSwcRefuses : public testing::TestWithParam<Refused> {};

TEST_P(ReadSwcRefuses, SayingLineFoundAndExpected) {
  EXPECT_EQ(refusal(GetParam().text), "tree.swc: " + std::string(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, ReadSwcRefuses,
    testing::Values(
        Refused{"", "has no points; expected: id type x y z radius parent"},
        Refused{"# only\n\n", "has no points; expected: id type x y z radius parent"},
        Refused{"1 0 0 0 0 1\n",
                "line 1: has 6 of 7 columns; expected: id type x y z radius parent"},
        Refused{"1,0,0,0,0,1,-1\n",
                "line 1: has 1 of 7 columns; expected: id type x y z radius parent"},
        Refused{"1 0 1,5 0 0 1 -1\n", "line 1: x is \"1,5\"; expected a number"},
        Refused{"1 0 0 nan 0 1 -1\n", "line 1: y is \"nan\"; expected a number"},
        Refused{"1 0 0 0 -inf 1 -1\n", "line 1: z is \"-inf\"; expected -1e9 to 1e9"},
        Refused{"1 0 1e400 0 0 1 -1\n", "line 1: x is \"1e400\"; expected -1e9 to 1e9"},
        Refused{"1 0 1e39 0 0 1 -1\n", "line 1: x is \"1e39\"; expected -1e9 to 1e9"},
        Refused{"1 0 0 0 0 1e39 -1\n",
                "line 1: the radius is \"1e39\"; expected a positive number up to 1e9"},
        Refused{"1 0 +-1 0 0 1 -1\n", "line 1: x is \"+-1\"; expected a number"},
        Refused{"1 0 2e9 0 0 1 -1\n", "line 1: x is \"2e9\"; expected -1e9 to 1e9"},
        Refused{"1 0 0 0 0 2e9 -1\n",
                "line 1: the radius is \"2e9\"; expected a positive number up to 1e9"},
        Refused{"1 0 0 0 0 0 -1\n",
                "has no radius at any point of it; expected one at some point at least (its sixth "
                "column)"},
        Refused{"1 0 0 0 0 -1 -1\n2 0 1 1 1 1 -1\n",
                "has no radius at any point of one of its trees; expected one at some point at "
                "least (its sixth column)"},
        Refused{"1.5 0 0 0 0 1 -1\n",
                "line 1: the id is \"1.5\"; expected a whole number from 0 to 2147483647"},
        Refused{"3000000000 0 0 0 0 1 -1\n",
                "line 1: the id is \"3000000000\"; expected a whole number from 0 to 2147483647"},
        Refused{"1 0 0 0 0 1 -2\n",
                "line 1: the parent is \"-2\"; expected a whole number from -1 to 2147483647"},
        Refused{"1 0 0 0 0 1 -1\n2 0 0 0 0 1 7\n",
                "line 2: the parent is 7, which no line has as its id; expected the id of a point, "
                "or -1 of a root"},
        Refused{"1 0 0 0 0 1 -1\n\n1 0 0 0 0 1 -1\n",
                "line 3: the id 1 is that of line 1 already; expected one point of each id"},
        Refused{"1 0 0 0 0 1 1\n",
                "line 1: the parent is \"1\", the point itself; expected another point, or -1 of a "
                "root"},
        Refused{"1 0 0 0 0 1 -1\n5 0 0 0 0 1 4\n3 0 0 0 0 1 4\n4 0 0 0 0 1 3\n",
                "line 3: the parents of point 3 lead back to it; expected a way to a root, whose "
                "parent is -1"},
        Refused{"1 0 \x1b[2Jabcdefghijklmnopqrstuvwxyz 0 0 1 -1\n",
                "line 1: x is \"\\u001b[2Jabcdefghijklmnopqrstuvwxyz\"; expected a number"}));

TEST(ReadSwc, ALongChainThatRunsBackwardsTakesNoRecursion) {
  std::string text;
  const int count = 200000;
  for (int i = 1; i <= count; ++i)
    text += std::to_string(i) + " 0 " + std::to_string(i) + " 0 0 1 " +
            std::to_string(i == count ? -1 : i + 1) + "\n";
  const CenterlineFile file = parseSwc(text, "tree.swc");
  EXPECT_EQ(file.points.front().position.x(), count);
  EXPECT_EQ(file.points.back().parent, count - 2);
}

TEST(ReadSwc, AFileThatIsNotThereIsNamed) {
  try {
    readSwc("no-such.swc");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_EQ(std::string(error.what()).rfind("no-such.swc: there is no such centerline", 0), 0U);
  }
}

TEST(ReadSwc, RealTreesAreRead) {
  const std::filesystem::path folder = std::filesystem::path(LUMEN_SHARED_DATA) / "arteries";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "there is no " << folder;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".swc") continue;
    ++files;
    const CenterlineFile file = readSwc(entry.path());
    EXPECT_GT(file.points.size(), 1000U);
    const std::vector<CenterlineChain> chains = centerlineChains(file);
    EXPECT_GT(chains.size(), 70U);
    EXPECT_LT(chains.size(), 140U);
  }
  EXPECT_GT(files, 0U);
}

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
