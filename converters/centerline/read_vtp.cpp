// SPDX-License-Identifier: Apache-2.0
#include "converters/centerline/read_vtp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "converters/centerline/fill_radii.h"
#include "converters/centerline/join_curves.h"
#include "converters/centerline/read_text.h"
#include "converters/common/error.h"
#include "converters/common/vtk_xml.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestVtp = 1e9;
constexpr std::size_t kMostLines = 10000;  // every line is held against every other one
constexpr std::array<std::string_view, 5> kRadiusNames = {"MaximumInscribedSphereRadius", "Radius",
                                                          "radius", "CenterlineIds", "TractIds"};

const VtkArray* radiiOf(const VtkPolyData& data) {
  for (std::size_t i = 0; i < 3; ++i)
    if (const VtkArray* found = data.pointArray(kRadiusNames[i]);
        found != nullptr && found->components == 1)
      return found;
  return nullptr;
}

// For each line its place: lines of one centerline in the order of their tracts.
std::vector<std::vector<std::size_t>> whole(const VtkPolyData& data) {
  const std::size_t before = data.verts.size();
  const VtkArray* centerline = data.cellArray("CenterlineIds");
  const VtkArray* tract = data.cellArray("TractIds");
  std::vector<std::vector<std::size_t>> ways;
  if (centerline == nullptr || tract == nullptr || centerline->components != 1 ||
      tract->components != 1) {
    for (std::size_t line = 0; line < data.lines.size(); ++line) ways.push_back({line});
    return ways;
  }
  std::map<double, std::vector<std::size_t>> byCenterline;
  for (std::size_t line = 0; line < data.lines.size(); ++line) {
    const double id = centerline->values[before + line];
    if (std::isfinite(id) && std::isfinite(tract->values[before + line]))
      byCenterline[id].push_back(line);
    else
      ways.push_back({line});
  }
  for (auto& [id, lines] : byCenterline) {
    std::stable_sort(lines.begin(), lines.end(), [&](std::size_t a, std::size_t b) {
      return tract->values[before + a] < tract->values[before + b];
    });
    ways.push_back(std::move(lines));
  }
  return ways;
}

CurvePoint pointOf(const VtkPolyData& data, const VtkArray* radii, std::uint32_t index,
                   const std::string& name) {
  CurvePoint point{data.position[index], radii == nullptr ? 0.0 : radii->values[index]};
  if (!(point.position.cwiseAbs().maxCoeff() <= kLargestVtp))
    throw invalidInput(name + ": point " + std::to_string(index) +
                       " is not finite or beyond 1e9; expected coordinates");
  if (!(std::abs(point.radius) <= kLargestVtp))
    throw invalidInput(name + ": the radius of point " + std::to_string(index) + " is " +
                       std::to_string(point.radius) + "; expected a positive number up to 1e9");
  point.radius = std::max(0.0, point.radius);
  return point;
}

}  // namespace

CenterlineFile parseVtpCenterline(std::string_view text, const std::string& name) {
  const std::string shown = formats::printable(name);
  const VtkPolyData data = parseVtkXml(text, name, kRadiusNames);
  const std::vector<std::vector<std::size_t>> ways = whole(data);
  if (ways.empty())
    throw invalidInput(shown + ": has no lines" +
                       (data.polys.size() > 0
                            ? " but " + std::to_string(data.polys.size()) + " polygons"
                            : std::string()) +
                       "; expected a centerline");
  if (ways.size() > kMostLines)
    throw invalidInput(shown + ": has " + std::to_string(ways.size()) +
                       " lines; expected at most 10000, one for each vessel or way to a tip");
  const VtkArray* radii = radiiOf(data);
  std::vector<CenterlineCurve> curves;
  for (const auto& way : ways) {
    CenterlineCurve curve;
    for (const std::size_t line : way)
      for (std::uint32_t i = data.lines.begin(line); i < data.lines.end[line]; ++i)
        curve.points.push_back(pointOf(data, radii, data.lines.point[i], shown));
    if (!curve.points.empty()) curves.push_back(std::move(curve));
  }
  CenterlineFile file = joinCurves(curves);
  if (radii == nullptr)
    file.remarks.push_back("has no array MaximumInscribedSphereRadius or Radius of its points");
  else
    fillRadii(file, shown, "the array MaximumInscribedSphereRadius of its points");
  return file;
}

CenterlineFile readVtpCenterline(const fs::path& file) {
  return parseVtpCenterline(readCenterlineText(file, "VTK's XML"), file.string());
}

}  // namespace lumen::convert
