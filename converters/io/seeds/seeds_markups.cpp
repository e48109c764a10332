// SPDX-License-Identifier: Apache-2.0
// 3D Slicer Markups as seeds (Slicer's markups-schema-v1.0.3.json).
// Declared in seeds_parse.h.

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "converters/base/length_unit.h"
#include "converters/base/text.h"
#include "converters/io/seeds/seeds_parse.h"

namespace lumen::convert {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// "LPS" (the default), "RAS", or the numbers of older versions: 1 and 0.
SeedSystem systemOf(const JsonPlace& markup, const SeedReading& reading) {
  if (reading.system) return *reading.system;
  if (!markup.has("coordinateSystem")) return SeedSystem::Lps;
  const JsonPlace place = markup.at("coordinateSystem");
  const auto& value = place.value();
  if (value.is("LPS") || value.is("1") || value.is(1)) return SeedSystem::Lps;
  if (value.is("RAS") || value.is("0") || value.is(0)) return SeedSystem::Ras;
  place.refuse("\"LPS\" or \"RAS\"; " + reading.word("seeds-frame") + " states another");
}

/// A unit of length, mm by default; a coded unit such as ["mm", "UCUM", "millimeter"] is read by its
/// first word.
double unitScale(const JsonPlace& markup, const SeedReading& reading) {
  if (reading.unit) return *reading.unit;
  if (!markup.has("coordinateUnits")) return 1;
  const JsonPlace unit = markup.at("coordinateUnits");
  const auto words = unit.value().isArray() ? unit.elements() : std::vector<JsonPlace>{unit};
  if (words.empty()) unit.refuse("a unit of length, such as \"mm\"");
  if (const auto known = millimetresPer(words[0].text())) return *known;
  words[0].refuse("\"mm\", \"m\" or another unit of length; " + reading.word("seeds-unit") +
                  " states another");
}

/// Millimetres in the unit of a measurement, which is that of the coordinates unless it states one.
double unitOfMeasurement(const JsonPlace& measurement, const SeedFrame& frame,
                         const SeedReading& reading) {
  if (reading.unit || !measurement.has("units")) return frame.unit;
  const std::string* const word = measurement.at("units").value().text();
  return word == nullptr ? frame.unit : millimetresPer(*word).value_or(frame.unit);
}

/// The values of the measurement "Radius", mm, one for each control point; none if there is none.
std::vector<double> radii(const JsonPlace& markup, std::size_t points, const SeedFrame& frame,
                          const SeedReading& reading) {
  std::vector<double> values;
  if (!markup.has("measurements")) return values;
  for (const auto& measurement : markup.at("measurements").elements()) {
    if (!measurement.has("name") || !measurement.has("controlPointValues")) continue;
    if (lowerCase(measurement.at("name").text()) != "radius") continue;
    const auto entries = measurement.at("controlPointValues").elements();
    if (entries.size() != points)
      measurement.at("controlPointValues")
          .refuse(std::to_string(points) + " radii, one for each control point");
    const double unit = unitOfMeasurement(measurement, frame, reading);
    for (const auto& entry : entries) values.push_back(unit * entry.number());
  }
  return values;
}

/// Applies the description of a control point or of a markup to its branch.
void describe(const JsonPlace& holder, SeedBranch& branch) {
  if (!holder.has("description")) return;
  const JsonPlace place = holder.at("description");
  applyDescription(place.text(), branch,
                   [&](const std::string& expected) { place.refuse(expected); });
}

struct ControlPoint {
  JsonPlace place;
  SeedPoint point;
};

/// The control points that have a position; Slicer keeps others as placeholders.
std::vector<ControlPoint> controlPoints(const JsonPlace& markup, const SeedFrame& frame,
                                        const SeedReading& reading) {
  const auto places = markup.at("controlPoints").elements();
  const std::vector<double> radius = radii(markup, places.size(), frame, reading);
  std::vector<ControlPoint> points;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const JsonPlace& place = places[i];
    if (place.has("positionStatus") && place.at("positionStatus").text() != "defined") continue;
    SeedPoint point{frame.position(place.at("position").vector()), std::nullopt};
    if (!radius.empty()) point.radius = radius[i];
    points.push_back({place, point});
  }
  return points;
}

std::string textOr(const JsonPlace& place, const char* key, const std::string& fallback) {
  const std::string text = place.has(key) ? place.at(key).text() : std::string();
  return text.empty() ? fallback : text;
}

/// Each control point of a Fiducial markup begins a branch of its own.
void addFiducials(const JsonPlace& markup, const SeedFrame& frame, const SeedReading& reading,
                  const std::string& name, std::vector<SeedBranch>& branches) {
  int number = 0;
  for (const auto& [place, point] : controlPoints(markup, frame, reading)) {
    SeedBranch branch;
    branch.frame = frame;
    branch.label = textOr(place, "label", name + "-" + std::to_string(++number));
    branch.points = {point};
    describe(place, branch);
    branches.push_back(std::move(branch));
  }
}

/// A line or curve is one branch.
void addCurve(const JsonPlace& markup, const SeedFrame& frame, const SeedReading& reading,
              const std::string& name, std::vector<SeedBranch>& branches) {
  SeedBranch branch;
  branch.frame = frame;
  branch.label = name;
  const auto points = controlPoints(markup, frame, reading);
  for (const auto& control : points) branch.points.push_back(control.point);
  if (!points.empty()) describe(points[0].place, branch);
  describe(markup, branch);
  branches.push_back(std::move(branch));
}

}  // namespace

std::vector<SeedBranch> parseMarkups(const JsonPlace& root, const std::string& stem,
                                     const SeedReading& reading) {
  std::vector<SeedBranch> branches;
  for (const auto& markup : root.at("markups").elements()) {
    const SeedFrame frame{systemOf(markup, reading), unitScale(markup, reading)};
    const std::string type = markup.at("type").text(), name = textOr(markup, "name", stem);
    if (type == "Fiducial")
      addFiducials(markup, frame, reading, name, branches);
    else if (type == "Line" || type == "Curve" || type == "ClosedCurve")
      addCurve(markup, frame, reading, name, branches);
    else
      markup.at("type").refuse(
          "\"Fiducial\", \"Line\", \"Curve\" or \"ClosedCurve\": points on vessels; save those "
          "alone");
  }
  return branches;
}

std::string markupsText(const std::vector<SeedBranch>& seeds) {
  OrderedJson markups = OrderedJson::array();
  for (const SeedBranch& seed : seeds) {
    std::string description = "kind=" + kindOf(seed);
    if (seed.parent) description += "; parent=" + *seed.parent;
    OrderedJson points = OrderedJson::array(), radii = OrderedJson::array();
    for (const SeedPoint& point : seed.points) {
      const Eigen::Vector3d& p = point.position;
      points.push_back({{"position", {p.x(), p.y(), p.z()}}, {"positionStatus", "defined"}});
      if (point.radius) radii.push_back(*point.radius);
    }
    OrderedJson curve = {{"type", seed.points.size() == 1 ? "Fiducial" : "Curve"},
                         {"name", seed.label},
                         {"coordinateSystem", "LPS"},
                         {"coordinateUnits", "mm"}};
    points[0]["label"] = seed.label;
    points[0]["description"] = description;
    curve["controlPoints"] = std::move(points);
    if (!radii.empty() && radii.size() == seed.points.size())
      curve["measurements"] = {
          {{"name", "Radius"}, {"enabled", true}, {"units", "mm"}, {"controlPointValues", radii}}};
    markups.push_back(std::move(curve));
  }
  const OrderedJson root = {
      {"@schema",
       "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
       "Schema/markups-schema-v1.0.3.json#"},
      {"markups", std::move(markups)}};
  return root.dump(2) + "\n";
}

}  // namespace lumen::convert
