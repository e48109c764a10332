// SPDX-License-Identifier: Apache-2.0
// Units and axes of centerlines; declared in case_of_centerline.h.
#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "converters/geometry/far_origin.h"
#include "converters/io/centerline/case_of_centerline.h"

namespace lumen::convert {
namespace {

// The size by which vessels are known, in the file's unit: as of tubes around the segments.
VesselSize sizeOf(const CenterlineFile& file) {
  double area = 0, volume = 0;
  for (const CenterlinePoint& point : file.points) {
    if (point.parent == kNoPoint) continue;
    const CenterlinePoint& before = file.points[static_cast<std::size_t>(point.parent)];
    const double length = (point.position - before.position).norm();
    const double radius = 0.5 * (point.radius + before.radius);
    area += radius * length;
    volume += radius * radius * length;
  }
  return {area > 0 ? volume / area : std::numeric_limits<double>::quiet_NaN(),
          measureExtent(file).diagonal};
}

// Moves points in mm that lie far from 0.
void moveFarPoints(CenterlineFile& file) {
  Eigen::Vector3d low = file.points.front().position;
  for (const CenterlinePoint& point : file.points) low = low.cwiseMin(point.position);
  const Eigen::Vector3d move = farMove(low);
  if (move.isZero(0)) return;
  for (CenterlinePoint& point : file.points) point.position -= move;
  file.assumptions.push_back(farSentence("its points are", move));
  file.remarks.push_back(file.assumptions.back());
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

ReadFrame toPatientSpace(CenterlineFile& file, const CenterlineReading& reading) {
  if (file.points.empty()) return {};
  ReadFrame frame{reading.unit.value_or(file.unit), reading.unit ? "option" : "file",
                  reading.axes.has_value() || file.axes != CenterlineAxes::Unknown};
  if (!reading.unit) {
    const VesselSize size = sizeOf(file);
    std::string warning;
    if (frame.unit == 0) {
      const UnitGuess guess = guessUnit(size, file.isOfSimVascular);
      frame.unit = guess.millimetres;
      frame.unitFrom = "guess";
      warning = unitWarning(guess, size, file.isOfSimVascular, reading.word);
    } else {
      warning = statedWarning(size, frame.unit, UnitBy::File, reading.word);
    }
    if (!warning.empty()) file.remarks.push_back(std::move(warning));
  }
  const double unit = frame.unit;
  const CenterlineAxes axes = reading.axes.value_or(file.axes);
  for (CenterlinePoint& point : file.points) {
    point.position *= unit;
    point.radius *= unit;
    if (axes == CenterlineAxes::Ras) point.position.head<2>() *= -1;
  }
  if (axes == CenterlineAxes::Ras && !reading.axes)
    file.remarks.emplace_back("the file states RAS: x and y were negated, to LPS");
  moveFarPoints(file);
  file.unit = 1;
  file.axes = CenterlineAxes::Lps;
  return frame;
}

}  // namespace lumen::convert
