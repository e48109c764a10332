// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/measure_answer.h"

#include <cmath>
#include <span>
#include <utility>

#include "formats/case/vessel_system.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

std::string measuredText(const Measured& m, int digits) {
  if (!m.absent.empty()) return "-";
  if (std::isfinite(m.atMost)) return "<= " + fixedText(m.atMost, digits);
  const std::string value = fixedText(m.value, digits);
  return std::isfinite(m.plusMinus) ? value + " +- " + fixedText(m.plusMinus, digits) : value;
}

std::string vesselText(const formats::Case& source, const convert::CaseMeasures& measures) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"vessel", "length", "tortuosity", "mean curvature", "mean radius",
                  "smallest radius", "volume"});
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(source);
  if (!systems.empty()) rows.front().insert(rows.front().begin() + 1, "system");
  for (const convert::VesselMeasures& m : measures.vessels) {
    rows.push_back({source.tree.branches[m.branch].label, measuredText(m.length, 1),
                    measuredText(m.tortuosity, 3), measuredText(m.meanCurvature, 3),
                    measuredText(m.meanRadius, 2), measuredText(m.smallestRadius, 2),
                    measuredText(m.volume, 1)});
    if (!systems.empty()) {
      const auto system = static_cast<std::size_t>(systems[m.branch]);
      rows.back().insert(rows.back().begin() + 1, std::string(formats::kVesselSystemNames[system]));
    }
  }
  return alignColumns(rows);
}

/// Empty without an aneurysm.
std::string sacText(const formats::Case& source, const convert::CaseMeasures& measures) {
  if (measures.sacs.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"aneurysm", "neck", "height", "width", "volume", "aspect ratio", "size ratio"});
  for (const convert::SacMeasures& m : measures.sacs)
    rows.push_back({source.tree.branches[m.branch].label, measuredText(m.neckDiameter, 2),
                    measuredText(m.height, 2), measuredText(m.width, 2), measuredText(m.volume, 1),
                    measuredText(m.aspectRatio, 2), measuredText(m.sizeRatio, 2)});
  return "\n" + alignColumns(rows);
}

std::string countText(const std::vector<convert::MeasureTable>& tables) {
  std::string text;
  for (const convert::MeasureTable& table : tables)
    text += (text.empty() ? "" : ", ") + std::string(table.kind) + " " +
            std::to_string(table.rows.size());
  return text;
}

}  // namespace

Json measureJson(const std::vector<convert::MeasuredCase>& cases, const std::string& against) {
  constexpr std::size_t kMembers = 4;  // an object that grows copies all that its members hold
  Json json = Json::object();
  json.get_ref<Json::object_t&>().reserve(kMembers);
  json["cases"] = Json::array();
  json["against"] = against.empty() ? Json(nullptr) : Json(against);
  json["changes"] = nullptr;
  for (const convert::MeasuredCase& one : cases) {
    const std::span<const convert::MeasureTable> tables(one.tables);
    Json entry = Json::object(),
         kinds = convert::measuresJson(tables.first(convert::kMeasureKinds));
    entry.get_ref<Json::object_t&>().reserve(1 + kinds.size());
    entry["case"] = one.name;
    for (auto& [kind, rows] : kinds.get_ref<Json::object_t&>()) entry[kind] = std::move(rows);
    json["cases"].push_back(std::move(entry));
    if (!against.empty())
      json["changes"] = convert::measuresJson(tables.subspan(convert::kMeasureKinds));
  }
  return json;
}

std::string measureText(const std::string& file, const formats::Case& source,
                        const operations::CaseMeasures& measures) {
  return formats::printable(file) + ": " + countText(measures.tables) + "\n\n" +
         vesselText(source, measures.values) + sacText(source, measures.values) + "\n";
}

std::string changesText(const std::string& against,
                        const std::vector<convert::MeasureTable>& changes) {
  return "against " + formats::printable(against) + ": " + countText(changes) + "\n\n";
}

}  // namespace lumen::engine
