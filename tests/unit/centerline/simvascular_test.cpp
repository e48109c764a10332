// SPDX-License-Identifier: Apache-2.0
// Paths, contours and projects of SimVascular, as sv3_PathIO.cxx and sv4gui_ContourGroupIO.cxx of SimVascular
// write them.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "line_files.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr const char* kHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<format version=\"1.0\" />\n";

std::string placeOf(const std::string& tag, const Vector3d& p) {
  return "<" + tag + " x=\"" + std::to_string(p.x()) + "\" y=\"" + std::to_string(p.y()) +
         "\" z=\"" + std::to_string(p.z()) + "\" />\n";
}

/// A straight path from a place, with 41 points.
std::string pathOf(int id, const Vector3d& from, const Vector3d& step) {
  std::string text = kHead;
  text += "<path id=\"" + std::to_string(id) +
          "\" method=\"2\" calculation_number=\"0\" spacing=\"0.1\">\n<timestep id=\"0\">\n"
          "<path_element method=\"2\">\n<control_points>\n" +
          placeOf("point id=\"0\"", from) + "</control_points>\n<path_points>\n";
  for (int i = 0; i <= 40; ++i)
    text += "<path_point id=\"" + std::to_string(i) + "\">\n" + placeOf("pos", from + i * step) +
            placeOf("tangent", step) + "</path_point>\n";
  return text + "</path_points>\n</path_element>\n</timestep>\n</path>\n";
}

/// A circle of a radius around a place, across an axis, of a contour of a path's place.
std::string contourOf(const Vector3d& onPath, const Vector3d& centre, const Vector3d& axis,
                      double radius) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.normalized().cross(u);
  std::string text =
      "<contour id=\"0\" type=\"Circle\" method=\"Manual\" closed=\"true\">\n<path_point "
      "id=\"0\">\n" +
      placeOf("pos", onPath) + placeOf("tangent", axis) + "</path_point>\n<control_points>\n" +
      placeOf("point id=\"0\"", centre) + placeOf("point id=\"1\"", centre + 9 * u) +
      "</control_points>\n<contour_points>\n";
  for (int i = 0; i < 64; ++i) {
    const double angle = 2 * std::numbers::pi * i / 64;
    text += placeOf("point id=\"" + std::to_string(i) + "\"",
                    centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return text + "</contour_points>\n</contour>\n";
}

std::string groupOf(const std::string& path, const std::string& contours, int times = 1) {
  std::string text = std::string(kHead) + "<contourgroup path_name=\"" + path +
                     "\" path_id=\"1\" reslice_size=\"5\">\n";
  for (int t = 0; t < times; ++t)
    text += "<timestep id=\"" + std::to_string(t) +
            "\">\n<lofting_parameters method=\"nurbs\" />\n" + (t == 0 ? contours : std::string()) +
            "</timestep>\n";
  return text + "</contourgroup>\n";
}

/// An aorta of 1 cm along z from 0 to 12 cm, and a branch of 0.5 cm from it; contours lie 0.1 cm beside the
/// paths.
class SimVascularProject : public testing::Test {
protected:
  void SetUp() override {
    fs::create_directories(m_root / "Paths");
    fs::create_directories(m_root / "Segmentations");
    const Vector3d along(0, 0, 0.3), out(0.25, 0, 0.1), beside(0, 0.1, 0);
    write("Paths/aorta.pth", pathOf(1, {0, 0, 0}, along));
    write("Paths/iliac.pth", pathOf(2, {0, 0, 6}, out));
    write("Paths/unused.pth", pathOf(3, {0, 0, 0}, {1, 0, 0}));
    std::string aorta, iliac;
    for (int i = 4; i <= 36; i += 8)
      aorta += contourOf(i * along, i * along + beside, along, 1.0 - 0.01 * i);
    for (int i = 2; i <= 38; i += 12)
      iliac += contourOf(Vector3d(0, 0, 6) + i * out, Vector3d(0, 0, 6) + i * out, out, 0.5);
    write("Segmentations/aorta.ctgr", groupOf("aorta", aorta, 2));
    write("Segmentations/iliac.ctgr", groupOf("iliac", iliac));
  }
  void TearDown() override { fs::remove_all(m_root); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(m_root / name, std::ios::binary) << text;
  }
  const fs::path m_root = fs::path(testing::TempDir()) / "lumen-simvascular";
};

TEST_F(SimVascularProject, IsOneTreeOfItsPathsWithTheRadiiOfContours) {
  EXPECT_TRUE(hasSimVascular(m_root));
  CenterlineFile file = readSimVascular(m_root);
  ASSERT_EQ(test::rootsOf(file).size(), 1U);
  // from the first contour to the last, in their middles
  EXPECT_LT((test::rootsOf(file)[0] - Vector3d(0, 0.1, 1.2)).norm(), 1e-5);
  EXPECT_EQ(file.vessels, (std::vector<std::string>{"aorta", "iliac"}));
  EXPECT_EQ(centerlineChains(file).size(), 2U);
  const CenterlineExtent extent = measureExtent(file);
  // a polygon of 64 corners has an area 0.16 % less than its circle
  EXPECT_NEAR(extent.most, 0.96, 0.001);
  EXPECT_NEAR(extent.least, 0.5, 0.001);
  std::string remarks;
  for (const std::string& remark : file.remarks) remarks += remark + "\n";
  EXPECT_NE(remarks.find("1 path has no contours, and is left out\n"), remarks.npos) << remarks;
  EXPECT_NE(remarks.find("holds 2 times, of which the first is read\n"), remarks.npos) << remarks;
  EXPECT_EQ(toPatientSpace(file, {}).unit, 10);  // cm
}

TEST_F(SimVascularProject, AFileFindsItsCounterpart) {
  const CenterlineFile byPath = readSimVascular(m_root / "Paths" / "iliac.pth");
  const CenterlineFile byContours = readSimVascular(m_root / "Segmentations" / "iliac.ctgr");
  ASSERT_EQ(byPath.points.size(), byContours.points.size());
  EXPECT_EQ(byPath.points.size(), 37U);  // points 2 to 38 of the path
  EXPECT_NEAR(test::lengthOf(byPath), 36 * std::hypot(0.25, 0.1), 1e-4);
  EXPECT_EQ(byPath.vessels, std::vector<std::string>{"iliac"});
}

TEST_F(SimVascularProject, ContoursAloneAreStraightBetweenTheirMiddles) {
  fs::remove_all(m_root / "Paths");
  const CenterlineFile file = readSimVascular(m_root / "Segmentations" / "iliac.ctgr");
  EXPECT_EQ(file.points.size(), 4U);
  EXPECT_EQ(file.remarks.at(0),
            "1 group of contours lies without its path, so the vessel runs straight from middle to "
            "middle");
}

TEST_F(SimVascularProject, APathAloneHasNoRadiiAndARemarkThatHelps) {
  fs::remove_all(m_root / "Segmentations");
  const CenterlineFile file = readSimVascular(m_root / "Paths" / "aorta.pth");
  EXPECT_EQ(file.points.size(), 41U);
  EXPECT_EQ(file.radiiMissing(), 41U);
  EXPECT_EQ(
      file.remarks.at(0),
      "has paths alone, without radii; SimVascular saves contours around them in the project's "
      "folder Segmentations, and lumen reads the folder of the project");
}

TEST(SimVascularFile, AContourWithoutAreaIsLeftOutAndABadNumberRefused) {
  const std::string flat = "<contour id=\"9\"><path_point id=\"0\">" + placeOf("pos", {0, 0, 3}) +
                           "</path_point><contour_points>" + placeOf("point id=\"0\"", {0, 0, 3}) +
                           placeOf("point id=\"1\"", {0, 1, 3}) + "</contour_points></contour>";
  const std::string two =
      contourOf({0, 0, 0}, {0, 0, 0}, {0, 0, 1}, 1) + contourOf({0, 0, 9}, {0, 0, 9}, {0, 0, 1}, 1);
  const CenterlineFile file = parseSimVascular(groupOf("a", two + flat), "a.ctgr");
  EXPECT_EQ(file.points.size(), 2U);
  EXPECT_EQ(file.remarks.back(), "1 contour has no area, and is left out");
  std::string bad = groupOf("a", two);
  bad.replace(bad.find("x=\"0.000000\""), 12, "x=\"zero\"");
  try {
    parseSimVascular(bad, "a.ctgr");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a.ctgr: line 8: x is \"zero\"; expected a number from -1e9 to 1e9");
  }
}

}  // namespace
}  // namespace lumen::convert
