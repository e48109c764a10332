// SPDX-License-Identifier: Apache-2.0
// Facts that comments of SWC files state, and trees that come apart in them.
#include <gtest/gtest.h>

#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "line_files.h"

namespace lumen::convert {
namespace {

const std::string kTwoPoints = "1 0 0 0 0 2 -1\n2 0 0 0 10 2 1\n";

CenterlineFile read(const std::string& comments, const std::string& points = kTwoPoints) {
  return parseSwc(comments + points, "t.swc");
}

TEST(SwcComments, StateTheUnitOfAllPoints) {
  const std::vector<std::pair<std::string, double>> comments = {
      {"# All positions and radii in \xC2\xB5m\n", 1e-3},
      {"# All positions and radii in um\n# Voxel separation (x,y,z): 0.33, 0.33, 1.0\n", 1e-3},
      {"# Units: microns\n", 1e-3},
      {"#unit=nm\n", 1e-6},
      {"# Meta: {\"name\": \"a\", \"units\": \"8 nanometer\"}\n", 8e-6},
      {"# coordinates are in millimeters\n", 1},
      {"# id type x[cm] y[cm] z[cm] r[cm] parent\n", 10},
      {"# id, type, x (mm), y (mm), z (mm), r, parent\n", 1}};
  for (const auto& [comment, unit] : comments) {
    CenterlineFile file = read(comment);
    EXPECT_EQ(file.unit, unit) << comment;
    EXPECT_EQ(file.remarks.size(), 1U) << comment;
    EXPECT_EQ(toPatientSpace(file, {}).unitFrom, "file") << comment;
    EXPECT_NEAR(file.points[1].position.z(), 10 * unit, 1e-12) << comment;
    EXPECT_NEAR(file.points[1].radius, 2 * unit, 1e-12) << comment;
  }
}

TEST(SwcComments, OnOtherThingsStateNothing) {
  for (const char* const comment :
       {"# Voxel size: 0.5 um\n", "# Imaged at a resolution of 1 um, positions in voxels\n",
        "# smoothed by 2 um\n", "# total length 300 um\n", "# positions moved by 3 mm\n",
        "# positions in mm, radii in um\n", "# Created in 1999 by M\n", "# X Y Z radius\n",
        "# a position in the left MCA\n", "# SCALE 1 1 1\n", "# SCALE 1.0 1.0 1.0\n"}) {
    const CenterlineFile file = read(comment);
    EXPECT_EQ(file.unit, 0) << comment;
    EXPECT_TRUE(file.remarks.empty()) << comment;
    EXPECT_EQ(file.points[1].position.z(), 10) << comment;
  }
}

TEST(SwcComments, AScaleIsAppliedAndReported) {
  const CenterlineFile file = read("# SCALE 2 2 2\n");
  EXPECT_EQ(file.points[1].position.z(), 20);
  EXPECT_NEAR(file.points[1].radius, 4, 1e-12);  // of 2
  EXPECT_EQ(
      file.remarks.at(0),
      "its comments state the scale 2 x 2 x 2: positions are multiplied by it, and radii by 2");
  const CenterlineFile flat = read("#scale 1, 1, 8\n");
  EXPECT_EQ(flat.points[1].position.z(), 80);
  EXPECT_NEAR(flat.points[1].radius, 4, 1e-12);  // by the cube root of 8
  for (const char* const bad : {"# SCALE 0 1 1\n", "# SCALE a b c\n", "# SCALE -1 1 1\n"}) {
    const CenterlineFile kept = read(bad);
    EXPECT_EQ(kept.points[1].position.z(), 10) << bad;
    EXPECT_EQ(kept.remarks.size(), 1U) << bad;
  }
}

TEST(SwcComments, AxesAndTheOwnFilesOfLumen) {
  EXPECT_EQ(read("# SPACE=RAS\n").axes, CenterlineAxes::Ras);
  const CenterlineFile own = read("# lumen: centerline, millimetres, LPS\n# units: um\n");
  EXPECT_EQ(own.unit, 1);
}

TEST(SwcUnits, OneRuleByTheSizeOfVessels) {
  const auto frameOf = [](double radius, double length, std::size_t remarks) {
    CenterlineFile file =
        read("", "1 0 0 0 0 " + std::to_string(radius) + " -1\n2 0 0 0 " + std::to_string(length) +
                     " " + std::to_string(radius) + " 1\n");
    const ReadFrame frame = toPatientSpace(file, {});
    EXPECT_EQ(file.remarks.size(), remarks) << radius;
    EXPECT_EQ(frame.unitFrom, "guess");
    return frame.unit;
  };
  EXPECT_EQ(frameOf(2, 60, 0), 1);          // an artery of a limb
  EXPECT_EQ(frameOf(1.1, 26, 1), 1);        // a small artery, or an aorta in cm
  EXPECT_EQ(frameOf(0.009, 0.3, 1), 1000);  // an aorta in m
  EXPECT_EQ(frameOf(600000, 5.4e7, 1), 1e-6);
  EXPECT_EQ(frameOf(40, 4000, 1), 1e-3);  // an arteriole
  EXPECT_EQ(frameOf(1e9, 1e9, 1), 1);     // no vessel in any unit
}

TEST(SwcTrees, APathThatBeginsOnATrunkIsAttachedThere) {
  std::string trunk;
  for (int i = 0; i <= 20; ++i)
    trunk += std::to_string(i + 1) + " 0 0 0 " + std::to_string(i) + " 2 " +
             std::to_string(i == 0 ? -1 : i) + "\n";
  // at a point, between two points, beside the axis, before the trunk in the file
  const std::vector<std::string> files = {trunk + "90 0 0 0 10 1 -1\n91 0 5 0 10 1 90\n",
                                          trunk + "90 0 0 0 10.4 1 -1\n91 0 5 0 10 1 90\n",
                                          trunk + "90 0 0.5 1 10.4 1 -1\n91 0 5 0 10 1 90\n",
                                          "90 0 0 0 10 1 -1\n91 0 5 0 10 1 90\n" + trunk};
  for (const std::string& text : files) {
    const CenterlineFile file = read("", text);
    EXPECT_EQ(test::rootsOf(file), std::vector<Eigen::Vector3d>{Eigen::Vector3d::Zero()}) << text;
    EXPECT_EQ(centerlineChains(file).size(), 2U);
    EXPECT_EQ(file.remarks.size(), 1U);
  }
  const CenterlineFile apart = read("", trunk + "90 0 2.5 0 10 1 -1\n91 0 9 0 10 1 90\n");
  EXPECT_EQ(test::rootsOf(apart).size(), 2U);
  EXPECT_TRUE(apart.remarks.empty());
}

TEST(SwcTrees, ARootThatIsThereTwiceIsOne) {
  const CenterlineFile alone = read("0 1 0 0 0 2 -1\n", kTwoPoints);
  EXPECT_EQ(test::rootsOf(alone).size(), 1U);
  const CenterlineFile both =
      read("", kTwoPoints + "8 0 0 0 0 2 -1\n9 0 7 0 0 2 8\n10 0 9 0 0 2 9\n");
  EXPECT_EQ(test::rootsOf(both).size(), 1U);
  EXPECT_NEAR(test::lengthOf(both), 19, 1e-12);
}

}  // namespace
}  // namespace lumen::convert
