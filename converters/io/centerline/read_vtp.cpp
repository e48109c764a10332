// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/length_unit.h"
#include "converters/base/number_text.h"
#include "converters/base/options/stated_unit.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/geometry/far_origin.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/join_curves.h"
#include "converters/io/centerline/tree_of_lines.h"
#include "converters/io/vtk/vtk_legacy.h"
#include "converters/io/vtk/vtk_xml.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kLargestVtp = 1e9;
constexpr std::size_t kHead = 1024;  // position limit of a comment of write_vtp.cpp
// Array of cells by which VMTK's networks are known, whose lines have no direction.
constexpr const char* kUndirected = "Topology";
// Arrays of points by which centerlines of SimVascular are known.
constexpr const char* kOfSimVascular = "BranchId";
constexpr const char* kAlsoOfSimVascular = "BifurcationId";
constexpr std::array<std::string_view, 9> kVtpArrays = {"MaximumInscribedSphereRadius",
                                                        "Radius",
                                                        "radius",
                                                        "CenterlineIds",
                                                        "TractIds",
                                                        "Branch",
                                                        kUndirected,
                                                        kOfSimVascular,
                                                        kAlsoOfSimVascular};

const VtkArray* radiiOf(const VtkPolyData& data) {
  for (std::size_t i = 0; i < 3; ++i)
    if (const VtkArray* found = data.pointArray(kVtpArrays[i]);
        found != nullptr && found->components == 1)
      return found;
  return nullptr;
}

// The order of each line: lines of one centerline in the order of their tracts.
std::vector<std::vector<std::size_t>> whole(const VtkPolyData& data) {
  const std::size_t before = data.verts.size();
  const VtkArray* centerline = data.cellArray("CenterlineIds");
  const VtkArray* tract = data.cellArray("TractIds");
  std::vector<std::vector<std::size_t>> courses;
  if (centerline == nullptr || tract == nullptr || centerline->components != 1 ||
      tract->components != 1) {
    for (std::size_t line = 0; line < data.lines.size(); ++line) courses.push_back({line});
    return courses;
  }
  std::map<double, std::vector<std::size_t>> byCenterline;
  for (std::size_t line = 0; line < data.lines.size(); ++line) {
    const double id = centerline->values[before + line];
    if (std::isfinite(id) && std::isfinite(tract->values[before + line]))
      byCenterline[id].push_back(line);
    else
      courses.push_back({line});
  }
  for (auto& [id, lines] : byCenterline) {
    std::stable_sort(lines.begin(), lines.end(), [&](std::size_t a, std::size_t b) {
      return tract->values[before + a] < tract->values[before + b];
    });
    courses.push_back(std::move(lines));
  }
  return courses;
}

CurvePoint pointOf(const VtkPolyData& data, const VtkArray* radii, std::uint32_t index,
                   const std::string& name) {
  CurvePoint point{data.position[index], radii == nullptr ? 0.0 : radii->values[index]};
  if (!isWithin(point.position, kLargestVtp))
    throw invalidInput(name + ": point " + std::to_string(index) +
                       " is not finite or beyond 1e9; expected coordinates");
  if (!(std::abs(point.radius) <= kLargestVtp))
    throw invalidInput(name + ": the radius of point " + std::to_string(index) + " is " +
                       foundNumber(point.radius) + "; expected a positive number up to 1e9");
  point.radius = std::max(0.0, point.radius);
  return point;
}

// The points that lines use, checked, with the vessels that the file numbers.
std::vector<CenterlinePoint> pointsOf(const VtkPolyData& data, const VtkArray* radii,
                                      const VtkArray* branch, const std::string& name) {
  std::vector<CenterlinePoint> points(data.position.size());
  std::vector<bool> isUsed(points.size(), false);
  for (const std::uint32_t point : data.lines.point) isUsed[point] = true;
  std::map<double, std::int32_t> vessels;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!isUsed[i]) continue;
    const CurvePoint point = pointOf(data, radii, static_cast<std::uint32_t>(i), name);
    points[i].position = point.position;
    points[i].radius = point.radius;
    if (branch != nullptr && std::isfinite(branch->values[i]))
      points[i].vessel =
          vessels.emplace(branch->values[i], static_cast<std::int32_t>(vessels.size()))
              .first->second;
  }
  return points;
}

LineSet linesOf(const VtkPolyData& data, const std::vector<CenterlinePoint>& points,
                const std::vector<std::vector<std::size_t>>& courses) {
  LineSet set{points, {}, data.cellArray(kUndirected) == nullptr};
  for (const auto& course : courses) {
    std::vector<std::int32_t>& line = set.lines.emplace_back();
    for (const std::size_t cell : course)
      for (std::uint32_t i = data.lines.begin(cell); i < data.lines.end[cell]; ++i)
        line.push_back(static_cast<std::int32_t>(data.lines.point[i]));
  }
  return set;
}

// Unit and axes as the file states them, in field data, in a title or in a comment of lumen.
void readFrame(const VtkPolyData& data, bool isOfLumen, CenterlineFile& file) {
  file.isOfLumen = isOfLumen;
  file.isOfSimVascular =
      data.pointArray(kOfSimVascular) != nullptr || data.pointArray(kAlsoOfSimVascular) != nullptr;
  StatedAxes axes = axesIn(data.space);
  if (axes == StatedAxes::None) axes = axesIn(data.title);
  if (axes == StatedAxes::Ras) file.axes = CenterlineAxes::Ras;
  if (axes == StatedAxes::Lps || isOfLumen) file.axes = CenterlineAxes::Lps;
  if (const auto unit = unitInComment(data.title)) {
    file.unit = unit->millimetres;
    file.remarks.push_back(unit->sentence());
  }
  if (const auto unit = millimetresPer(data.unit)) file.unit = *unit;
  for (std::string& sentence : data.unknownWords()) file.remarks.push_back(std::move(sentence));
  if (isOfLumen) file.unit = 1;
}

// Lines of a legacy file may name points that it has not, and arrays may be shorter.
void requireLegacyCounts(const VtkPolyData& data, const std::string& name) {
  for (const std::uint32_t point : data.lines.point)
    if (point >= data.position.size())
      throw invalidInput(name + ": a line has the point " + std::to_string(point) +
                         "; expected less than " + std::to_string(data.position.size()) +
                         ", the number of points");
  const std::size_t cells =
      data.verts.size() + data.lines.size() + data.polys.size() + data.strips.size();
  const auto require = [&](const std::vector<VtkArray>& arrays, std::size_t count) {
    for (const VtkArray& array : arrays)
      if (array.values.size() != count * array.components)
        throw invalidInput(name + ": the array " + quotedText(array.name) + " has " +
                           std::to_string(array.values.size() / array.components) +
                           " values; expected " + std::to_string(count));
  };
  require(data.pointData, data.position.size());
  require(data.cellData, cells);
}

CenterlineFile treeOf(VtkPolyData data, bool isOfLumen, const std::string& shown) {
  if (data.lines.point.empty())
    throw invalidInput(shown + ": has no lines" +
                       (data.polys.size() > 0
                            ? " but " + std::to_string(data.polys.size()) + " polygons"
                            : std::string()) +
                       "; expected a centerline");
  // far from 0 the rounding of floats, within which points are one, is longer than their distances
  const Eigen::Vector3d back = moveNear(data.position);
  const VtkArray* radii = radiiOf(data);
  const VtkArray* branch = data.pointArray("Branch");
  if (branch != nullptr && branch->components != 1) branch = nullptr;
  const std::vector<CenterlinePoint> points = pointsOf(data, radii, branch, shown);
  std::vector<std::vector<std::size_t>> cells;
  for (std::size_t cell = 0; cell < data.lines.size(); ++cell) cells.push_back({cell});
  CenterlineFile file = treeOfLines(linesOf(data, points, cells),
                                    linesOf(data, points, whole(data)), isOfLumen, shown);
  if (file.points.empty())
    throw invalidInput(shown + ": all of its " + std::to_string(data.lines.size()) +
                       " lines have points at one place each; expected lines with a length");
  if (!back.isZero(0))
    for (CenterlinePoint& point : file.points) point.position += back;
  readFrame(data, isOfLumen, file);
  if (radii == nullptr)
    file.remarks.push_back("has no array MaximumInscribedSphereRadius or Radius of its points");
  else
    fillRadii(file, shown, "the array MaximumInscribedSphereRadius of its points");
  return file;
}

}  // namespace

CenterlineFile parseVtpCenterline(std::string_view text, const std::string& name) {
  const std::string shown = formats::printable(name);
  const bool isOfLumen = text.substr(0, kHead).find(kOwnCenterline) != text.npos;
  return treeOf(parseVtkXml(text, name, kVtpArrays), isOfLumen, shown);
}

CenterlineFile parseVtkCenterline(std::string_view bytes, const std::string& name) {
  const std::string shown = formats::printable(name);
  VtkPolyData data = parseVtkLegacy(bytes, shown, kVtpArrays);
  requireLegacyCounts(data, shown);
  return treeOf(std::move(data), false, shown);
}

CenterlineFile readVtpCenterline(const InputFile& file) {
  return parseVtpCenterline(file.read("centerline", kMostText), file.path().string());
}

CenterlineFile readVtkCenterline(const InputFile& file) {
  return parseVtkCenterline(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
