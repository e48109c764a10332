// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/measure_text.h"

#include <charconv>
#include <cmath>

#include "converters/base/number_text.h"

namespace lumen::convert {

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
          {"absent", isThere ? Json(nullptr) : Json(m.absent)}};
}

/// Vectors have no unit; places do.
std::string placeKey(std::string_view name) {
  const std::string text(name);
  if (text == "place") return "place_mm";
  if (text == "tangent" || text == "normal") return text;
  if (text.ends_with("_vector")) return text + "_mm";
  return text + "_place_mm";
}

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string cell(double value) {
  return std::isfinite(value) ? numberText(value, kDigits) : std::string();
}

void addHeader(const MeasureTable& table, std::string& text) {
  text += "case";
  for (const auto& label : table.labels) text += ',' + std::string(label);
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
            std::string& text) {
  text += csvCell(name);
  for (const std::string& label : row.labels) text += ',' + csvCell(label);
  for (const Place& place : row.places)
    for (int a = 0; a < 3; ++a) text += ',' + cell(place[a]);
  std::string absent;
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    const Measured& m = row.values[i];
    const bool isThere = m.absent.empty();
    text += ',' + (isThere ? cell(m.value) : "") + ',' + (isThere ? cell(m.plusMinus) : "");
    if (!isThere)
      absent += (absent.empty() ? "" : "; ") + std::string(table.values[i]) + ": " +
                std::string(m.absent);
  }
  text += ',' + csvCell(absent) + '\n';
}

}  // namespace

Json measuresJson(std::span<const MeasureTable> tables) {
  Json json = Json::object();
  for (const MeasureTable& table : tables) {
    Json rows = Json::array();
    for (const MeasureRow& row : table.rows) {
      Json object = Json::object();
      for (std::size_t i = 0; i < row.labels.size(); ++i)
        object[std::string(table.labels[i])] = row.labels[i];
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
  for (const MeasuredCase& one : cases) {
    const MeasureTable& table = one.tables[kind];
    if (text.empty()) addHeader(table, text);
    for (const MeasureRow& row : table.rows) addRow(one.name, table, row, text);
  }
  return text;
}

std::string measuresLongCsv(std::span<const MeasuredCase> cases) {
  std::string text = "case,kind,of,x_mm,y_mm,z_mm,measure,value,plus_minus,absent\n";
  for (const MeasuredCase& one : cases)
    for (const MeasureTable& table : one.tables)
      for (const MeasureRow& row : table.rows) {
        std::string of;
        for (const std::string& label : row.labels) of += (of.empty() ? "" : "; ") + label;
        std::string head = csvCell(one.name) + ',' + std::string(table.kind) + ',' + csvCell(of);
        for (int a = 0; a < 3; ++a) head += ',' + cell(row.places.front()[a]);
        for (std::size_t i = 0; i < row.values.size(); ++i) {
          const Measured& m = row.values[i];
          const bool isThere = m.absent.empty();
          text += head + ',' + std::string(table.values[i]) + ',' + (isThere ? cell(m.value) : "") +
                  ',' + (isThere ? cell(m.plusMinus) : "") + ',' + csvCell(std::string(m.absent)) +
                  '\n';
        }
      }
  return text;
}

}  // namespace lumen::convert
