// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/join_curves.h"
#include "converters/io/vtk/vtk_xml.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kLargestVtp = 1e9;
constexpr std::size_t kHead = 1024;        // position limit of a comment of write_vtp.cpp
constexpr std::size_t kMostLines = 10000;  // limit, as every pair of lines is compared
constexpr std::array<std::string_view, 6> kVtpArrays = {
    "MaximumInscribedSphereRadius", "Radius", "radius", "CenterlineIds", "TractIds", "Branch"};

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
  if (!(point.position.cwiseAbs().maxCoeff() <= kLargestVtp))
    throw invalidInput(name + ": point " + std::to_string(index) +
                       " is not finite or beyond 1e9; expected coordinates");
  if (!(std::abs(point.radius) <= kLargestVtp))
    throw invalidInput(name + ": the radius of point " + std::to_string(index) + " is " +
                       foundNumber(point.radius) + "; expected a positive number up to 1e9");
  point.radius = std::max(0.0, point.radius);
  return point;
}

// The tree of lines that share points; empty unless the lines determine each point's predecessor.
std::optional<CenterlineFile> sharedTree(const VtkPolyData& data, const VtkArray* radii,
                                         const std::string& name) {
  const std::size_t count = data.position.size();
  constexpr std::int64_t kUnused = -2;
  std::vector<std::int64_t> before(count, kUnused);
  std::vector<std::size_t> uses(count, 0);
  for (std::size_t line = 0; line < data.lines.size(); ++line)
    for (std::uint32_t i = data.lines.begin(line); i < data.lines.end[line]; ++i) {
      const std::uint32_t point = data.lines.point[i];
      ++uses[point];
      if (i == data.lines.begin(line)) {
        if (before[point] == kUnused) before[point] = kNoPoint;
        continue;
      }
      const std::int64_t previous = data.lines.point[i - 1];
      if (before[point] >= 0 && before[point] != previous) return std::nullopt;
      before[point] = previous;
    }
  // separate lines are joined by their places instead
  if (std::none_of(uses.begin(), uses.end(), [](std::size_t n) { return n > 1; }))
    return std::nullopt;
  const VtkArray* branch = data.pointArray("Branch");
  if (branch != nullptr && branch->components != 1) branch = nullptr;
  CenterlineFile file;
  std::map<double, std::int32_t> vessels;
  std::vector<std::int32_t> place(count, kNoPoint);
  const auto add = [&](std::size_t i) {
    const CurvePoint point = pointOf(data, radii, static_cast<std::uint32_t>(i), name);
    const std::int32_t parent = before[i] < 0 ? kNoPoint : place[std::size_t(before[i])];
    std::int32_t vessel = kNoVessel;
    if (branch != nullptr && std::isfinite(branch->values[i]))
      vessel = vessels.emplace(branch->values[i], static_cast<std::int32_t>(vessels.size()))
                   .first->second;
    place[i] = static_cast<std::int32_t>(file.points.size());
    file.points.push_back({point.position, point.radius, parent, 0, vessel});
  };
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t at = i; before[at] != kUnused && place[at] == kNoPoint;) {
      open.push_back(at);
      if (before[at] < 0) break;
      at = static_cast<std::size_t>(before[at]);
      if (open.size() > count) return std::nullopt;  // a cycle
    }
    for (; !open.empty(); open.pop_back()) add(open.back());
  }
  file.vessels.resize(vessels.size());
  return file;
}

CenterlineFile joinedLines(const VtkPolyData& data, const VtkArray* radii,
                           const std::string& name) {
  const std::vector<std::vector<std::size_t>> courses = whole(data);
  if (courses.size() > kMostLines)
    throw invalidInput(name + ": has " + std::to_string(courses.size()) +
                       " lines; expected at most 10000, one for each vessel or way to a tip");
  std::vector<CenterlineCurve> curves;
  for (const auto& course : courses) {
    CenterlineCurve curve;
    for (const std::size_t line : course)
      for (std::uint32_t i = data.lines.begin(line); i < data.lines.end[line]; ++i)
        curve.points.push_back(pointOf(data, radii, data.lines.point[i], name));
    if (!curve.points.empty()) curves.push_back(std::move(curve));
  }
  return joinCurves(curves);
}

}  // namespace

CenterlineFile parseVtpCenterline(std::string_view text, const std::string& name) {
  const std::string shown = formats::printable(name);
  const VtkPolyData data = parseVtkXml(text, name, kVtpArrays);
  if (data.lines.point.empty())
    throw invalidInput(shown + ": has no lines" +
                       (data.polys.size() > 0
                            ? " but " + std::to_string(data.polys.size()) + " polygons"
                            : std::string()) +
                       "; expected a centerline");
  const VtkArray* radii = radiiOf(data);
  std::optional<CenterlineFile> shared = sharedTree(data, radii, shown);
  CenterlineFile file = shared ? *std::move(shared) : joinedLines(data, radii, shown);
  if (text.substr(0, kHead).find(kOwnCenterline) != text.npos) {
    file.unit = 1;
    file.axes = CenterlineAxes::Lps;
    file.isOfLumen = true;
  }
  if (radii == nullptr)
    file.remarks.push_back("has no array MaximumInscribedSphereRadius or Radius of its points");
  else
    fillRadii(file, shown, "the array MaximumInscribedSphereRadius of its points");
  return file;
}

CenterlineFile readVtpCenterline(const InputFile& file) {
  return parseVtpCenterline(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
