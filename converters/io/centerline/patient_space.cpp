// SPDX-License-Identifier: Apache-2.0
// Units and axes of centerlines; declared in case_of_centerline.h.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "converters/io/centerline/case_of_centerline.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

// Bounds of a plausible vessel tree in millimetres: no vessel is wider than the first (the widest
// aneurysms of an aorta are 70 mm in radius), and no body longer than the second. A tree below the
// third is stated in metres: a whole vessel tree of 2 mm would be a mouse's glomerulus.
constexpr double kWidestRadius = 75, kLongestBody = 2500, kShortestTree = 2;

constexpr std::array<std::pair<double, const char*>, 4> kUnitNames = {
    {{1e-3, "micrometres"}, {1, "millimetres"}, {10, "centimetres"}, {1000, "metres"}}};

const char* unitName(double unit) {
  for (const auto& [value, name] : kUnitNames)
    if (value == unit) return name;
  return "units";
}

}  // namespace

CenterlineExtent measureExtent(const CenterlineFile& file) {
  CenterlineExtent extent;
  Eigen::Vector3d low = file.points.front().position, high = low;
  std::vector<double> radii;
  for (const CenterlinePoint& point : file.points) {
    low = low.cwiseMin(point.position);
    high = high.cwiseMax(point.position);
    if (point.radius > 0) radii.push_back(point.radius);
    if (point.parent != kNoPoint)
      extent.length +=
          (point.position - file.points[static_cast<std::size_t>(point.parent)].position).norm();
  }
  extent.diagonal = (high - low).norm();
  if (radii.empty()) return extent;
  std::sort(radii.begin(), radii.end());
  extent.least = radii.front();
  extent.median = radii[radii.size() / 2];
  extent.most = radii.back();
  return extent;
}

double plausibleUnit(const CenterlineFile& file) {
  const CenterlineExtent extent = measureExtent(file);
  if (extent.most > kWidestRadius || extent.diagonal > kLongestBody) return 1e-3;
  return extent.diagonal < kShortestTree ? 1000 : 1;
}

double toPatientSpace(CenterlineFile& file, const CenterlineReading& reading) {
  if (file.points.empty()) return 1;
  double unit = reading.unit.value_or(file.unit);
  if (unit == 0) {
    unit = plausibleUnit(file);
    const CenterlineExtent extent = measureExtent(file);
    if (unit != 1)
      file.remarks.push_back(std::string("lengths are taken as ") + unitName(unit) +
                             ": as millimetres the tree would "
                             "be " +
                             formats::shortText(static_cast<float>(extent.diagonal)) +
                             " mm long with radii of up to " +
                             formats::shortText(static_cast<float>(extent.most)) + " mm; " +
                             reading.word("unit") + " states another");
  }
  const CenterlineAxes axes = reading.axes.value_or(file.axes);
  for (CenterlinePoint& point : file.points) {
    point.position *= unit;
    point.radius *= unit;
    if (axes == CenterlineAxes::Ras) point.position.head<2>() *= -1;
  }
  file.unit = 1;
  file.axes = CenterlineAxes::Lps;
  return unit;
}

}  // namespace lumen::convert
