// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/measure_case.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_invoke.h>

#include "converters/base/csv_rows.h"
#include "converters/base/number_text.h"
#include "converters/judge/measure/shown_radius.h"
#include "converters/judge/measure/vessel_course.h"
#include "converters/judge/measure/vessel_measures.h"

namespace lumen::convert {

namespace {

constexpr double kTaperRadii = 3;  // to either side: the stretch of a station's taper
// Standard deviations by which the least of four independent normal errors lies below none: the
// wall's noise brings the nearest of its places nearer.
constexpr double kLeastOfFour = 1.029;
constexpr std::string_view kNearEnd = "too near to an end of the vessel for the curve's window";
constexpr std::string_view kNoTorsion = "the curvature is not significant: a line has no torsion";
constexpr std::string_view kAxisOutside = "the axis lies outside of the lumen";

void addSection(const CourseSample& sample, StationMeasures& out) {
  if (!sample.section) {
    out.area = out.perimeter = out.leastDiameter = out.greatestDiameter = out.circularity =
        notDefined(sample.absent);
    return;
  }
  const Section& s = *sample.section;
  out.area = measured(s.area, s.perimeter * sample.meanSd);
  out.perimeter = measured(s.perimeter, 2 * std::numbers::pi * sample.meanSd);
  out.leastDiameter = measured(s.least, 2 * sample.placeSd);
  out.greatestDiameter = measured(s.greatest, 2 * sample.placeSd);
  // the ring's bends change the perimeter beside the area
  out.circularity =
      measured(s.circularity, 2 * s.circularity * std::sqrt(std::max(0.0, 1 - s.circularity)) *
                                      sample.placeSd / sample.radius +
                                  std::pow(sample.placeSd / sample.radius, 2));
}

StationMeasures stationOf(std::uint32_t branch, const std::vector<CourseSample>& samples,
                          std::size_t i, double endSd) {
  const CourseSample& sample = samples[i];
  StationMeasures out;
  out.branch = branch;
  out.node = sample.node;
  out.place = sample.axis.position;
  out.tangent = sample.axis.tangent;
  out.along = measured(sample.along, endSd);
  if (!sample.axis.isWhole) {
    out.curvature = out.torsion = notDefined(kNearEnd);
  } else {
    const AxisPlace& axis = sample.axis;
    out.curvature = measured(axis.curvature, axis.curvatureSd, axis.curvatureBias);
    out.torsion = std::isfinite(axis.torsion)
                      ? measured(axis.torsion, axis.torsionSd, axis.torsionBias)
                      : notDefined(kNoTorsion);
  }
  out.radius = std::isfinite(sample.radius)
                   ? measured(sample.radius, sample.placeSd, kLeastOfFour * sample.placeSd)
                   : notDefined(kAxisOutside);
  addSection(sample, out);
  std::size_t first = i, last = i + 1;
  const double reach = kTaperRadii * sample.axis.radius;
  while (first > 0 && sample.along - samples[first - 1].along <= reach) --first;
  while (last < samples.size() && samples[last].along - sample.along <= reach) ++last;
  out.taper = sample.section ? taperOf(samples, first, last) : notDefined(sample.absent);
  return out;
}

void addStations(const formats::CenterlineTree& tree, const VesselCourse& course,
                 const MeasureOptions& options, const Wall* wall, const WallNoise* noise,
                 std::vector<StationMeasures>& out) {
  std::vector<CourseSample> own;
  if (options.step) {
    std::vector<double> along;
    const double length = course.length();
    for (std::size_t i = 0; static_cast<double>(i) * *options.step <= length; ++i) {
      const double at = static_cast<double>(i) * *options.step - course.gap + course.begin;
      if (at >= 0) along.push_back(at);
    }
    own = sampleCourse(tree, course, along, wall, noise);
  }
  const std::vector<CourseSample>& samples = options.step ? own : course.samples;
  for (std::size_t i = 0; i < samples.size(); ++i)
    out.push_back(stationOf(course.branch, samples, i, course.endSd));
}

/// All measures but those of aneurysms.
void measureVesselsOf(const formats::Case& source, const MeasureOptions& options, const Wall* wall,
                      const WallNoise* noise, Progress& progress, CaseMeasures& out) {
  const std::vector<VesselCourse> courses = vesselCourses(source, wall, noise, progress);
  const double shared = noise ? noise->shared() : 0;
  for (const VesselCourse& course : courses)
    if (course.absent.empty()) addStations(source.tree, course, options, wall, noise, out.stations);
  out.vessels = measureVessels(courses, shared);
  out.forks = measureForks(source.tree, courses);
  out.paths = measurePaths(source.tree, courses, out.forks, shared, progress);
  out.narrowings = measureNarrowings(courses);
}

}  // namespace

CaseMeasures measureCase(const formats::Case& source, const MeasureOptions& options,
                         Progress& progress) {
  const bool hasWall = source.models && source.tree.nodeCount() > 0;
  const std::optional<Wall> wall = hasWall ? std::optional<Wall>(source) : std::nullopt;
  const std::optional<WallNoise> noise =
      wall ? std::optional<WallNoise>(std::in_place, source, *wall) : std::nullopt;
  const Wall* cut = wall ? &*wall : nullptr;
  const WallNoise* spread = noise ? &*noise : nullptr;
  CaseMeasures out;
  // a sac is the work of one thread, which is as long as that of all vessels
  tbb::parallel_invoke([&] { out.sacs = measureSacs(source, spread, progress); },
                       [&] { measureVesselsOf(source, options, cut, spread, progress, out); });
  boundRadii(leastShownRadius(source.metadata), out);
  return out;
}

namespace {

using Json = nlohmann::ordered_json;

constexpr int kDigits = 6;

Json jsonOf(double value) {
  if (!std::isfinite(value)) return nullptr;
  const std::string text = numberText(value, kDigits);
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}

Json jsonOf(const Place& place) {
  if (!place.allFinite()) return nullptr;
  return {jsonOf(place.x()), jsonOf(place.y()), jsonOf(place.z())};
}

Json jsonOf(const Measured& m) {
  const bool isThere = m.absent.empty();
  return {{"value", isThere ? jsonOf(m.value) : Json(nullptr)},
          {"plus_minus", isThere ? jsonOf(m.plusMinus) : Json(nullptr)},
          {"absent", isThere ? Json(nullptr) : Json(m.absent)},
          {"at_most", jsonOf(m.atMost)}};
}

/// Vectors have no unit; places do.
std::string placeKey(std::string_view name) {
  const std::string text(name);
  if (text == "place") return "place_mm";
  if (text == "tangent" || text == "normal") return text;
  if (text.ends_with("_vector")) return text + "_mm";
  return text + "_place_mm";
}

std::string cell(double value) {
  return std::isfinite(value) ? numberText(value, kDigits) : std::string();
}

/// Why a number is not there, or is a bound; empty for others.
std::string remark(const Measured& m) {
  if (!std::isfinite(m.atMost)) return std::string(m.absent);
  return "at most " + cell(m.atMost) + ": the volume shows no less";
}

bool hasSystems(const MeasureTable& table) {
  return !table.rows.empty() && !table.rows.front().system.empty();
}

/// Whether a case has systems, so that rows of all have a column for it.
bool haveSystems(std::span<const MeasuredCase> cases, std::size_t kind) {
  return std::any_of(cases.begin(), cases.end(),
                     [&](const MeasuredCase& one) { return hasSystems(one.tables[kind]); });
}

void addHeader(const MeasureTable& table, bool withSystems, std::string& text) {
  text += "case";
  for (const auto& label : table.labels) text += ',' + std::string(label);
  if (withSystems) text += ",system";
  for (const auto& place : table.places) {
    const std::string key = placeKey(place);
    const bool isLength = key.ends_with("_mm");
    const std::string stem =
        key == "place_mm" ? "" : key.substr(0, key.size() - (isLength ? 3 : 0)) + '_';
    for (const char axis : {'x', 'y', 'z'}) text += ',' + stem + axis + (isLength ? "_mm" : "");
  }
  for (const auto& value : table.values)
    text += ',' + std::string(value) + ',' + std::string(value) + "_pm";
  text += ",absent\n";
}

void addRow(const std::string& name, const MeasureTable& table, const MeasureRow& row,
            bool withSystems, std::string& text) {
  text += csvCell(name);
  for (const std::string& label : row.labels) text += ',' + csvCell(label);
  if (withSystems) text += ',' + std::string(row.system);
  for (const Place& place : row.places)
    for (int a = 0; a < 3; ++a) text += ',' + cell(place[a]);
  std::string absent;
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    const Measured& m = row.values[i];
    const bool isThere = m.absent.empty();
    text += ',' + (isThere ? cell(m.value) : "") + ',' + (isThere ? cell(m.plusMinus) : "");
    if (const std::string why = remark(m); !why.empty())
      absent += (absent.empty() ? "" : "; ") + std::string(table.values[i]) + ": " + why;
  }
  text += ',' + csvCell(absent) + '\n';
}

/// An object with room for its members: one that grows copies them with all that they hold.
Json objectOf(std::size_t members) {
  Json object = Json::object();
  object.get_ref<Json::object_t&>().reserve(members);
  return object;
}

}  // namespace

Json measuresJson(std::span<const MeasureTable> tables) {
  Json json = objectOf(tables.size());
  for (const MeasureTable& table : tables) {
    Json rows = Json::array();
    for (const MeasureRow& row : table.rows) {
      Json object = objectOf(row.labels.size() + 1 + row.places.size() + row.values.size());
      for (std::size_t i = 0; i < row.labels.size(); ++i)
        object[std::string(table.labels[i])] = row.labels[i];
      if (!row.system.empty()) object["system"] = row.system;
      for (std::size_t i = 0; i < row.places.size(); ++i)
        object[placeKey(table.places[i])] = jsonOf(row.places[i]);
      for (std::size_t i = 0; i < row.values.size(); ++i)
        object[std::string(table.values[i])] = jsonOf(row.values[i]);
      rows.push_back(std::move(object));
    }
    json[std::string(table.kind)] = std::move(rows);
  }
  return json;
}

Json measuresJson(const formats::Case& source, const MeasureOptions& options, Progress& progress) {
  return measuresJson(measureTables(source, measureCase(source, options, progress)));
}

std::string measuresCsv(std::span<const MeasuredCase> cases, std::size_t kind) {
  std::string text;
  const bool withSystems = haveSystems(cases, kind);
  for (const MeasuredCase& one : cases) {
    const MeasureTable& table = one.tables[kind];
    if (text.empty()) addHeader(table, withSystems, text);
    for (const MeasureRow& row : table.rows) addRow(one.name, table, row, withSystems, text);
  }
  return text;
}

std::string measuresLongCsv(std::span<const MeasuredCase> cases) {
  bool withSystems = false;
  for (std::size_t kind = 0; !cases.empty() && kind < cases.front().tables.size(); ++kind)
    withSystems = withSystems || haveSystems(cases, kind);
  std::string text = std::string("case,kind,of,") + (withSystems ? "system," : "") +
                     "x_mm,y_mm,z_mm,measure,value,plus_minus,absent\n";
  for (const MeasuredCase& one : cases)
    for (const MeasureTable& table : one.tables)
      for (const MeasureRow& row : table.rows) {
        std::string of;
        for (const std::string& label : row.labels) of += (of.empty() ? "" : "; ") + label;
        std::string head = csvCell(one.name) + ',' + std::string(table.kind) + ',' + csvCell(of);
        if (withSystems) head += ',' + std::string(row.system);
        for (int a = 0; a < 3; ++a) head += ',' + cell(row.places.front()[a]);
        for (std::size_t i = 0; i < row.values.size(); ++i) {
          const Measured& m = row.values[i];
          const bool isThere = m.absent.empty();
          text += head + ',' + std::string(table.values[i]) + ',' + (isThere ? cell(m.value) : "") +
                  ',' + (isThere ? cell(m.plusMinus) : "") + ',' + csvCell(remark(m)) + '\n';
        }
      }
  return text;
}

}  // namespace lumen::convert
