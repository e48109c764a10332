// SPDX-License-Identifier: Apache-2.0
// lumen measure: the geometry of cases as tables.
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/files.h"
#include "converters/base/options/option_name.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/judge/measure/measure_tables.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using convert::CaseMeasures, convert::MeasuredCase, convert::MeasureTable;

constexpr OptionName kAgainst{"against"};

/// Kinds of outputs by their names.
enum class MeasureOutput : std::uint8_t { None, Folder, Csv, Json };

MeasureOutput outputOf(const std::string& name) {
  if (name.empty()) return MeasureOutput::None;
  const std::string lower = lowerCase(name);
  if (lower.ends_with(".csv")) return MeasureOutput::Csv;
  if (lower.ends_with(".json")) return MeasureOutput::Json;
  return MeasureOutput::Folder;
}

std::string measuredText(const Measured& m, int digits) {
  if (!m.absent.empty()) return "-";
  const std::string value = fixedText(m.value, digits);
  return std::isfinite(m.plusMinus) ? value + " +- " + fixedText(m.plusMinus, digits) : value;
}

std::string vesselText(const formats::Case& source, const CaseMeasures& measures) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"vessel", "length", "tortuosity", "mean curvature", "mean radius",
                  "smallest radius", "volume"});
  for (const convert::VesselMeasures& m : measures.vessels)
    rows.push_back({source.tree.branches[m.branch].label, measuredText(m.length, 1),
                    measuredText(m.tortuosity, 3), measuredText(m.meanCurvature, 3),
                    measuredText(m.meanRadius, 2), measuredText(m.smallestRadius, 2),
                    measuredText(m.volume, 1)});
  return alignColumns(rows);
}

/// Empty without an aneurysm.
std::string sacText(const formats::Case& source, const CaseMeasures& measures) {
  if (measures.sacs.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"aneurysm", "neck", "height", "width", "volume", "aspect ratio", "size ratio"});
  for (const convert::SacMeasures& m : measures.sacs)
    rows.push_back({source.tree.branches[m.branch].label, measuredText(m.neckDiameter, 2),
                    measuredText(m.height, 2), measuredText(m.width, 2), measuredText(m.volume, 1),
                    measuredText(m.aspectRatio, 2), measuredText(m.sizeRatio, 2)});
  return "\n" + alignColumns(rows);
}

std::string countText(const std::vector<MeasureTable>& tables) {
  std::string text;
  for (const MeasureTable& table : tables)
    text += (text.empty() ? "" : ", ") + std::string(table.kind) + " " +
            std::to_string(table.rows.size());
  return text;
}

class MeasureCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "measure"; }
  [[nodiscard]] std::string summary() const override {
    return "Measure vessels, paths, forks, narrowings and aneurysms, with uncertainties, as tables";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen measure head.lumen --out head-measures\n"
           "  lumen measure first.lumen second.lumen --out both.csv\n"
           "  lumen measure after.lumen --against before.lumen --json";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_cases, "Cases; tables of several name the case in each row").many();
    table.file(
        "out", m_output,
        "Write the tables: a new FOLDER with a CSV for each kind, or one FILE.csv with a row "
        "for each number, or FILE.json");
    table
        .add("step", &m_step, "MM",
             "Distance of the stations along a vessel in mm [half of its median radius]")
        .in(NumberRange{0.01, 1e3});
    addTimeRow(table, m_time);
    table.file(kAgainst.name, m_before,
               "Earlier case of the same patient, in the same frame: also the differences of "
               "vessels that lie at the same place");
  }

  Answer run(const RunContext& context) override {
    requireInScope(*context.table, {}, context.progress);
    if (!m_before.empty() && m_cases.size() != 1)
      throw Error(ErrorKind::Usage, kAgainst.shown() + ": found " + std::to_string(m_cases.size()) +
                                        " cases beside it, expected one");
    auto folder = checkOutput();
    std::vector<MeasuredCase> measured;
    std::string text;
    for (const std::string& file : m_cases) {
      const formats::Case source =
          atTime(readCase(file), m_time, file, *context.table, context.progress);
      const CaseMeasures measures = measure(file, source, context.progress);
      measured.push_back({file, convert::measureTables(source, measures)});
      text += formats::printable(file) + ": " + countText(measured.back().tables) + "\n\n" +
              vesselText(source, measures) + sacText(source, measures) + "\n";
      if (!m_before.empty()) addChanges(source, measures, measured.back(), text, context.progress);
    }
    Json json = answer(measured);
    json["files"] = Json::array();
    json["files"] = written(measured, json, folder);
    text += "Lengths in mm, curvatures in 1/mm, volumes in mm3; +- is half of the 95 % interval.\n";
    return {std::move(json), std::move(text), 0, true};
  }

private:
  /// Refuses an output that could not be written in the end, or would be lost.
  [[nodiscard]] std::optional<formats::PendingFolder> checkOutput() const {
    const MeasureOutput kind = outputOf(m_output);
    if (kind == MeasureOutput::None) return std::nullopt;
    if (kind != MeasureOutput::Folder) {
      requireWritable(m_output, convert::ContentKind::Other);
      return std::nullopt;
    }
    std::error_code error;
    if (std::filesystem::exists(m_output, error) &&
        !(std::filesystem::is_directory(m_output, error) &&
          std::filesystem::is_empty(m_output, error)))
      throw failed(m_output +
                   ": there is something already; expected a folder that does not exist or is "
                   "empty, or a name that ends in .csv or .json");
    auto folder =
        formats::PendingFolder::beside(m_output, formats::PendingFolder::Existing::Refuse);
    if (!folder) throw failed(folder.error().message);
    return std::move(*folder);
  }

  [[nodiscard]] CaseMeasures measure(const std::string& file, const formats::Case& source,
                                     Progress& progress) const {
    progress.begin("measure", 0);
    if (!source.models)
      progress.warn(file + ": has no models, so there are no cross-sections; lumen fit makes them");
    CaseMeasures measures = convert::measureCase(source, {m_step}, progress);
    progress.end();
    return measures;
  }

  [[nodiscard]] Json answer(const std::vector<MeasuredCase>& measured) const {
    Json json;
    json["cases"] = Json::array();
    json["against"] = m_before.empty() ? Json(nullptr) : Json(m_before);
    json["changes"] = nullptr;
    for (const MeasuredCase& one : measured) {
      // tables of changes follow those of measures
      const std::span<const MeasureTable> tables(one.tables);
      Json entry{{"case", one.name}};
      entry.update(convert::measuresJson(tables.first(convert::kMeasureKinds)));
      json["cases"].push_back(std::move(entry));
      if (!m_before.empty())
        json["changes"] = convert::measuresJson(tables.subspan(convert::kMeasureKinds));
    }
    return json;
  }

  void addChanges(const formats::Case& source, const CaseMeasures& measures, MeasuredCase& out,
                  std::string& text, Progress& progress) const {
    const formats::Case before = readCase(m_before);
    const CaseMeasures earlier = measure(m_before, before, progress);
    const auto changes = convert::measureChanges({before, earlier}, {source, measures});
    text += "against " + formats::printable(m_before) + ": " + countText(changes) + "\n\n";
    out.tables.insert(out.tables.end(), changes.begin(), changes.end());
  }

  /// Writes the tables; the names of the files as the answer lists them.
  [[nodiscard]] Json written(const std::vector<MeasuredCase>& measured, const Json& json,
                             std::optional<formats::PendingFolder>& folder) const {
    Json files = Json::array();
    switch (outputOf(m_output)) {
      case MeasureOutput::None:
        break;
      case MeasureOutput::Json:
        writeText(json.dump(1) + "\n", m_output);
        files.push_back(m_output);
        break;
      case MeasureOutput::Csv:
        writeText(convert::measuresLongCsv(measured), m_output);
        files.push_back(m_output);
        break;
      case MeasureOutput::Folder: {
        for (std::size_t k = 0; k < measured.front().tables.size(); ++k) {
          const std::string name = std::string(measured.front().tables[k].kind) + ".csv";
          writeNewFile(convert::measuresCsv(measured, k), folder->path() / name, m_output);
          files.push_back((std::filesystem::path(m_output) / name).generic_string());
        }
        const auto done = folder->commit();
        if (!done) throw failed(done.error().message);
      }
    }
    return files;
  }

  std::vector<std::string> m_cases;
  std::string m_output, m_before;
  std::optional<double> m_step, m_time;
};

}  // namespace

std::unique_ptr<Command> makeMeasureCommand() {
  return std::make_unique<MeasureCommand>();
}

}  // namespace lumen::engine
