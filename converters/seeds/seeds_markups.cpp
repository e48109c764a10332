// SPDX-License-Identifier: Apache-2.0
// 3D Slicer Markups as seeds (Slicer's markups-schema-v1.0.3.json).
#include "converters/seeds/seeds_markups.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "converters/common/error.h"
#include "converters/common/text.h"

namespace lumen::convert {
namespace {

using nlohmann::json;

/// "LPS" (the default), "RAS", or as older versions wrote them: 1 and 0.
bool isRas(const JsonPlace& markup) {
  if (!markup.has("coordinateSystem")) return false;
  const JsonPlace place = markup.at("coordinateSystem");
  const auto& value = place.value();
  if (value == "LPS" || value == "1" || value == 1) return false;
  if (value == "RAS" || value == "0" || value == 0) return true;
  place.refuse("\"LPS\" or \"RAS\"");
}

/// "mm" (the default) or "m"; a coded unit such as ["mm", "UCUM", "millimeter"] counts by its first
/// word.
double unitScale(const JsonPlace& markup) {
  if (!markup.has("coordinateUnits")) return 1;
  const JsonPlace unit = markup.at("coordinateUnits");
  if (!unit.value().is_array()) return scaleOf(unit);
  const auto words = unit.elements();
  if (words.empty()) unit.refuse("\"mm\" or \"m\"");
  return scaleOf(words[0]);
}

/// The values of the measurement "Radius", one for each control point; null if there is none.
std::vector<double> radii(const JsonPlace& markup, std::size_t points) {
  std::vector<double> values;
  if (!markup.has("measurements")) return values;
  for (const auto& measurement : markup.at("measurements").elements()) {
    if (!measurement.has("name") || !measurement.has("controlPointValues")) continue;
    std::string name = measurement.at("name").text();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name != "radius") continue;
    const auto entries = measurement.at("controlPointValues").elements();
    if (entries.size() != points)
      measurement.at("controlPointValues")
          .refuse(std::to_string(points) + " radii, one for each control point");
    for (const auto& entry : entries) values.push_back(entry.number());
  }
  return values;
}

/// Reads "parent=LABEL; kind=aneurysm; radius=2.5" from a description; words without "=" are
/// remarks.
void applyDescription(const JsonPlace& holder, const SeedFrame& frame, SeedBranch& branch) {
  if (!holder.has("description")) return;
  const JsonPlace place = holder.at("description");
  const std::string text = place.text();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const auto equals = part.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trimmed(part.substr(0, equals));
    const std::string value = trimmed(part.substr(equals + 1));
    if (key == "parent") {
      branch.parent = value;
    } else if (key == "kind" && branchKind(value)) {
      branch.kind = *branchKind(value);
    } else if (key == "radius") {
      char* rest = nullptr;
      const double radius = std::strtod(value.c_str(), &rest);
      if (value.empty() || *rest != '\0') place.refuse("a number after \"radius=\"");
      for (auto& point : branch.points)
        if (!point.radius) point.radius = frame.scale * radius;
    } else {
      place.refuse(
          "\"parent=LABEL\", \"kind=vessel\", \"kind=aneurysm\" or \"radius=NUMBER\" "
          "around each \"=\"");
    }
  }
}

struct ControlPoint {
  JsonPlace place;
  SeedPoint point;
};

/// The control points that have a position; Slicer keeps others as placeholders.
std::vector<ControlPoint> controlPoints(const JsonPlace& markup, const SeedFrame& frame) {
  const auto places = markup.at("controlPoints").elements();
  const std::vector<double> radius = radii(markup, places.size());
  std::vector<ControlPoint> points;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const JsonPlace& place = places[i];
    if (place.has("positionStatus") && place.at("positionStatus").text() != "defined") continue;
    SeedPoint point{frame.position(place.at("position").vector()), std::nullopt};
    if (!radius.empty()) point.radius = frame.scale * radius[i];
    points.push_back({place, point});
  }
  return points;
}

std::string textOr(const JsonPlace& place, const std::string& key, const std::string& fallback) {
  const std::string text = place.has(key) ? place.at(key).text() : std::string();
  return text.empty() ? fallback : text;
}

/// Each control point of a Fiducial markup begins a branch of its own.
void addFiducials(const JsonPlace& markup, const SeedFrame& frame, const std::string& name,
                  std::vector<SeedBranch>& branches) {
  int number = 0;
  for (const auto& [place, point] : controlPoints(markup, frame)) {
    SeedBranch branch;
    branch.label = textOr(place, "label", name + "-" + std::to_string(++number));
    branch.points = {point};
    applyDescription(place, frame, branch);
    branches.push_back(std::move(branch));
  }
}

/// A line or curve is one branch.
void addCurve(const JsonPlace& markup, const SeedFrame& frame, const std::string& name,
              std::vector<SeedBranch>& branches) {
  SeedBranch branch;
  branch.label = name;
  const auto points = controlPoints(markup, frame);
  for (const auto& control : points) branch.points.push_back(control.point);
  if (!points.empty()) applyDescription(points[0].place, frame, branch);
  applyDescription(markup, frame, branch);
  branches.push_back(std::move(branch));
}

}  // namespace

std::vector<SeedBranch> parseMarkups(const JsonPlace& root, const std::string& stem) {
  std::vector<SeedBranch> branches;
  for (const auto& markup : root.at("markups").elements()) {
    const SeedFrame frame{unitScale(markup), isRas(markup)};
    const std::string type = markup.at("type").text(), name = textOr(markup, "name", stem);
    if (type == "Fiducial")
      addFiducials(markup, frame, name, branches);
    else if (type == "Line" || type == "Curve" || type == "ClosedCurve")
      addCurve(markup, frame, name, branches);
    else
      markup.at("type").refuse("\"Fiducial\", \"Line\", \"Curve\" or \"ClosedCurve\"");
  }
  return branches;
}

}  // namespace lumen::convert
