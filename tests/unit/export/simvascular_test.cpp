// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../surface/closed_cases.h"
#include "converters/export/targets/targets.h"

namespace lumen::test {

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
