// SPDX-License-Identifier: Apache-2.0
// Walls around vessels that overlap, and the two surfaces of CathSim.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../surface/closed_cases.h"
#include "converters/base/progress.h"
#include "converters/export/targets/targets.h"
#include "kissing.h"

namespace lumen::test {

using namespace convert;

namespace {

constexpr double kDeep = -0.3;  // mm, the gap of two vessels that overlap

ExportResult write(ExportResult (*target)(const ExportInput&), const CommonOptions& options = {}) {
  Progress silent;
  const formats::Case source = kissingCase(kDeep);
  return target({source, options, {LengthUnit::Metre, Axes::Lps}, silent});
}

/// The number of triangles of a binary STL.
std::uint32_t trianglesOf(const ExportResult& result, const std::string& file) {
  for (const ExportFile& one : result.files) {
    if (!one.name.ends_with(file)) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, one.bytes.data() + 80, sizeof count);
    return count;
  }
  return 0;
}

}  // namespace

TEST(WallFiles, VesselsThatOverlapGetAWall) {
  for (const auto target : {exportPrint, exportIsaac, exportGodot}) {
    const ExportResult result = write(target);
    ASSERT_TRUE(result.surface.has_value());
    ASSERT_TRUE(result.surface->wall.has_value());
    EXPECT_EQ(result.surface->crossings, 0U);
  }
}

TEST(WallFiles, CathSimShowsAllTrianglesAndTouchesFewer) {
  CommonOptions options;
  options.maxPieces = 500;
  const ExportResult result = write(exportCathsim, options);
  const std::uint32_t shown = trianglesOf(result, "visual.stl"),
                      touched = trianglesOf(result, "simplified.stl");
  EXPECT_GT(shown, 500U);
  EXPECT_LE(touched, 500U);
  EXPECT_EQ(result.surface->triangles, touched);
  ASSERT_EQ(result.surface->errors.size(), 1U);
  EXPECT_GT(result.surface->errors.front(), 0);
}

TEST(WallFiles, CathSimShowsTheSimplifiedSurfaceWhereAnErrorIsAskedFor) {
  CommonOptions options;
  options.surface.maxError = SurfaceError{.mm = 0.05};
  const ExportResult result = write(exportCathsim, options);
  EXPECT_EQ(trianglesOf(result, "visual.stl"), trianglesOf(result, "simplified.stl"));
  options.maxPieces = trianglesOf(result, "visual.stl") / 2;
  const ExportResult fewer = write(exportCathsim, options);
  EXPECT_EQ(trianglesOf(fewer, "visual.stl"), trianglesOf(result, "visual.stl"));
  EXPECT_LE(trianglesOf(fewer, "simplified.stl"), options.maxPieces);
}

using namespace lumen::convert;

namespace {

std::string bytesOf(const ExportResult& result, const std::string& ending) {
  for (const ExportFile& file : result.files)
    if (file.name.ends_with(ending)) return file.bytes;
  return "";
}

/// The points of the first element of that name, in their order.
std::vector<Eigen::Vector3d> pointsOf(const std::string& text, const std::string& element) {
  const std::size_t begin = text.find("<" + element + ">");
  const std::string part = text.substr(begin, text.find("</" + element + ">") - begin);
  const std::regex point(R"re(<point id="\d+" x="(\S+)" y="(\S+)" z="(\S+)" />)re");
  std::vector<Eigen::Vector3d> points;
  for (std::sregex_iterator one(part.begin(), part.end(), point), end; one != end; ++one)
    points.emplace_back(std::stod((*one)[1]), std::stod((*one)[2]), std::stod((*one)[3]));
  return points;
}

}  // namespace

TEST(SimVascular, HasContoursInCentimetresAtTheNodesWithTheirRadii) {
  const formats::Case source = forkCase();
  const CommonOptions options;
  Progress silent;
  const ExportResult result =
      exportSimVascular({source, options, {LengthUnit::Centimetre, Axes::Lps}, silent});
  const std::string contours = bytesOf(result, ".ctgr");
  const auto controls = pointsOf(contours, "control_points");
  ASSERT_EQ(controls.size(), 2U);
  const formats::Vec3f& root = source.tree.centre[0];
  const Eigen::Vector3d centre = 0.1 * Eigen::Vector3d(root.x, root.y, root.z);
  const double radius = 0.1 * static_cast<double>(source.tree.radius[0]);
  EXPECT_LT((controls[0] - centre).norm(), 1e-5);
  EXPECT_NEAR((controls[1] - centre).norm(), radius, 1e-5);
  const auto around = pointsOf(contours, "contour_points");
  EXPECT_GT(around.size(), 20U);
  for (const Eigen::Vector3d& p : around) EXPECT_NEAR((p - centre).norm(), radius, 1e-5);
}

}  // namespace lumen::test
