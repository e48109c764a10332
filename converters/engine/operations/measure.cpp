// SPDX-License-Identifier: Apache-2.0
// lumen measure: the geometry of cases as tables.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/files.h"
#include "converters/base/options/option_name.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/measure_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/operations/measures_of.h"
#include "formats/case/atomic_file.h"

namespace lumen::engine {

namespace {

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

/// The name of a file without its folders, which may be a person's.
std::string baseName(const InputFile& file) {
  return std::filesystem::path(file.name()).filename().string();
}

/// The name of a case in tables: that of its file, with a number where another has it already.
std::string tableName(const InputFile& file, const std::vector<convert::MeasuredCase>& others) {
  const std::string name = baseName(file);
  std::string free = name;
  const auto isTaken = [&](const convert::MeasuredCase& other) { return other.name == free; };
  for (int i = 2; std::any_of(others.begin(), others.end(), isTaken); ++i)
    free = name + " (" + std::to_string(i) + ")";
  return free;
}

/// The tables on disk, under the name of --out.
class MeasureFiles {
public:
  /// Refuses an output that could not be written in the end, or would be lost.
  explicit MeasureFiles(const OutputFile& output)
      : m_output(output), m_kind(outputOf(output.name())) {
    if (m_kind == MeasureOutput::None) return;
    if (m_kind != MeasureOutput::Folder) {
      requireWritable(m_output, convert::ContentKind::Other);
      return;
    }
    std::error_code error;
    if (std::filesystem::exists(m_output.path(), error) &&
        !(std::filesystem::is_directory(m_output.path(), error) &&
          std::filesystem::is_empty(m_output.path(), error)))
      throw failed(m_output.name() +
                   ": there is something already; expected a folder that does not exist or is "
                   "empty, or a name that ends in .csv or .json");
    auto folder =
        formats::PendingFolder::beside(m_output.path(), formats::PendingFolder::Existing::Refuse);
    if (!folder) throw failed(folder.error().message);
    m_folder.emplace(std::move(*folder));
  }

  /// Writes the tables, or `json`; the names of the files as the answer lists them.
  Json write(const std::vector<convert::MeasuredCase>& measured, const Json& json) {
    if (m_kind == MeasureOutput::None) return Json::array();
    if (m_kind == MeasureOutput::Folder) return writeFolder(measured);
    writeText(
        m_kind == MeasureOutput::Json ? json.dump(1) + "\n" : convert::measuresLongCsv(measured),
        m_output);
    return Json::array({m_output.name()});
  }

private:
  Json writeFolder(const std::vector<convert::MeasuredCase>& measured) {
    Json files = Json::array();
    for (std::size_t k = 0; k < measured.front().tables.size(); ++k) {
      const std::string name = std::string(measured.front().tables[k].kind) + ".csv";
      writeNewFile(convert::measuresCsv(measured, k), m_folder->path() / name, m_output.name());
      files.push_back((m_output.path() / name).generic_string());
    }
    const auto done = m_folder->commit();
    if (!done) throw failed(done.error().message);
    return files;
  }

  const OutputFile& m_output;
  MeasureOutput m_kind;
  std::optional<formats::PendingFolder> m_folder;
};

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
    MeasureFiles files(m_output);
    if (m_cases.size() > 1)  // all of them can be read, before the first is measured
      for (const InputFile& file : m_cases) readCase(file);
    std::vector<convert::MeasuredCase> measured;
    std::string text;
    for (const InputFile& file : m_cases) {
      const formats::Case source =
          atTime(readCase(file), m_time, file.name(), *context.table, context.progress);
      const operations::CaseMeasures measures = measure(file.name(), source, context);
      measured.push_back({tableName(file, measured), measures.tables});
      text += measureText(file.name(), source, measures);
      if (m_before.empty()) continue;
      const auto changes = changesOf(source, measures, context);
      text += changesText(m_before.name(), changes);
      auto& tables = measured.back().tables;
      tables.insert(tables.end(), changes.begin(), changes.end());
    }
    Json json = measureJson(measured, baseName(m_before));
    json["files"] = Json::array();
    Json written = files.write(measured, json);
    // the answer names files as the command does
    for (std::size_t i = 0; i < m_cases.size(); ++i) json["cases"][i]["case"] = m_cases[i].name();
    if (!m_before.empty()) json["against"] = m_before.name();
    json["files"] = std::move(written);
    text += "Lengths in mm, curvatures in 1/mm, volumes in mm3; +- is half of the 95 % interval.\n";
    return {std::move(json), std::move(text), 0, true};
  }

private:
  [[nodiscard]] operations::CaseMeasures measure(const std::string& file,
                                                 const formats::Case& source,
                                                 const RunContext& context) const {
    if (!source.models)
      warn(context.progress,
           about(file, {WarningCode::ModelsMissing, "has no models, so there are no cross-sections",
                        "lumen fit makes them"}));
    return operations::measuresOf(source, {m_step}, operationContext(context));
  }

  [[nodiscard]] std::vector<convert::MeasureTable> changesOf(
      const formats::Case& source, const operations::CaseMeasures& measures,
      const RunContext& context) const {
    const formats::Case before = readCase(m_before);
    return convert::measureChanges({before, measure(m_before.name(), before, context).values},
                                   {source, measures.values});
  }

  std::vector<InputFile> m_cases;
  OutputFile m_output;
  InputFile m_before;
  std::optional<double> m_step, m_time;
};

}  // namespace

std::unique_ptr<Command> makeMeasureCommand() {
  return std::make_unique<MeasureCommand>();
}

}  // namespace lumen::engine
