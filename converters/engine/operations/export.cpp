// SPDX-License-Identifier: Apache-2.0
// lumen export: a case as the folder of files that a simulator loads.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/export_options.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/judge/facts/reachable.h"
#include "converters/operations/exported.h"
#include "formats/case/atomic_file.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

using convert::exportTargets, convert::ExportTarget, convert::ExportResult;

template <class Word>
std::string joined(const std::vector<Word>& words) {
  std::string text;
  for (const Word& word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

std::vector<std::string> shownNames(const std::vector<convert::TakenOption>& options) {
  std::vector<std::string> names;
  for (const convert::TakenOption& taken : options) names.push_back(optionWord()(taken.name));
  return names;
}

std::string lackedParts(const ExportTarget& target) {
  return std::string(target.lacks) +
         (target.unless.empty() ? "" : ", but for " + optionWord()(target.unless));
}

template <class Value>
std::vector<std::string_view> namesOf(const std::vector<Value>& values,
                                      std::string_view (*name)(Value)) {
  std::vector<std::string_view> names;
  for (const Value value : values) names.push_back(name(value));
  return names;
}

/// All of them in a new folder, which appears when it is complete.
void writeFolder(const std::vector<convert::ExportFile>& files, formats::PendingFolder& folder) {
  for (const convert::ExportFile& file : files) {
    const fs::path path = folder.path() / file.name;
    fs::create_directories(path.parent_path());
    writeNewFile(file.bytes, path);
    if (file.isProgram) allowRunning(path);
  }
  const auto done = folder.commit();
  if (!done) throw failed(done.error().message);
}

Json outletJson(const convert::OutletRow& row) {
  return {{"name", row.name},   {"radius_mm", row.radius}, {"tip_radius_mm", row.tip},
          {"share", row.share}, {"flow_ml_s", row.flow},   {"why", row.why()}};
}

std::string outletLines(const std::vector<convert::OutletRow>& outlets) {
  std::vector<std::vector<std::string>> rows{{"outlet", "radius mm", "share %", "ml/s", "by"}};
  for (const convert::OutletRow& row : outlets)
    rows.push_back({formats::printable(row.name), fixedText(row.radius, 2),
                    fixedText(100 * row.share, 1), fixedText(row.flow, 3), row.why()});
  return alignColumns(std::move(rows));
}

class ExportCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "export"; }
  [[nodiscard]] std::string summary() const override {
    return "Write the folder of files that a simulator loads";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen export sofa head.lumen head-sofa\n"
           "  lumen export sofa head.lumen coiling --instrument coil --insert aneurysm --wall "
           "implicit\n"
           "  lumen export mujoco heart.lumen systole --time 0.3\n"
           "  lumen export --list";
  }

  void addRows(OptionTable& table) override {
    table.flag("list", m_list, "List the targets, their files, units and frames, and exit");
    for (OptionRow* row :
         {&table.argument("TARGET", &m_target, "Reader of the folder: " + joinedNames(), {}),
          &table.argument("CASE", &m_input, "Case, with models"),
          &table.argument("FOLDER", &m_output,
                          "Folder to write; it may not exist, or must be empty")}) {
      row->isRequired = false;
      row->without("list");
    }
    addTimeRow(table, m_time);
    addExportRows(table, m_options);
    for (OptionRow& row : table.rows())
      if (!row.isArgument && row.name != "list") row.notBeside("list");
  }

  Answer run(const RunContext& context) override {
    if (m_list) {
      requireInScope(*context.table, {}, context.progress);
      return list();
    }
    if (m_output.empty())
      throw Error(ErrorKind::Usage, std::string(m_target.empty()  ? "TARGET"
                                                : m_input.empty() ? "CASE"
                                                                  : "FOLDER") +
                                        " is missing; usage: lumen export TARGET CASE FOLDER");
    const ExportTarget& target = exportTarget(m_target);
    requireTargetOptions(*context.table, target, context.progress);
    requireRoom();
    const formats::Case value =
        atTime(readCase(m_input), m_time, m_input.name(), *context.table, context.progress);
    auto folder =
        formats::PendingFolder::beside(m_output, formats::PendingFolder::Existing::Refuse);
    if (!folder) throw failed(folder.error().message);
    convert::warnOfClosed(convert::measureReach(value, context.progress), context.progress);
    const ExportResult result = operations::exported(
        value, m_input.name(),
        {target, m_options, exportOptionTexts(*context.table, target), m_output},
        operationContext(context));
    context.progress.check();
    writeFolder(result.files, *folder);
    return report(result, value);
  }

private:
  /// Before anything is made: the folder is not there, or is empty.
  void requireRoom() const {
    std::error_code error;
    const auto kind = std::filesystem::status(m_output, error).type();
    if (kind == std::filesystem::file_type::not_found ||
        (kind == std::filesystem::file_type::directory &&
         std::filesystem::is_empty(m_output, error) && !error))
      return;
    throw failed(m_output +
                 ": there is something already; expected a folder that does not exist, " +
                 "or is empty");
  }

  static std::string joinedNames() {
    std::string text;
    for (const std::string& name : exportTargetNames()) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  static Answer list() {
    Json targets = Json::array();
    std::string text;
    for (const ExportTarget& target : exportTargets()) {
      targets.push_back({{"name", target.name},
                         {"title", target.title},
                         {"files", target.files},
                         {"units", namesOf(target.units, convert::unitName)},
                         {"axes", namesOf(target.axes, convert::axesName)},
                         {"holds", target.holds},
                         {"lacks", lackedParts(target)},
                         {"options", shownNames(target.options)}});
      text += (text.empty() ? "" : "\n") +
              Lines()
                  .add(target.name, target.title)
                  .add("files", joined(target.files))
                  .add("unit, axes", joined(namesOf(target.units, convert::unitName)) + "; " +
                                         joined(namesOf(target.axes, convert::axesName)))
                  .add("holds", target.holds)
                  .add("lacks", lackedParts(target))
                  .add("options", joined(shownNames(target.options)))
                  .text();
    }
    return {Json{{"targets", std::move(targets)}}, std::move(text), 0, true};
  }

  [[nodiscard]] Answer report(const ExportResult& result, const formats::Case& value) const {
    Json json = caseSummary(value);
    json["target"] = m_target;
    Json files = Json::array();
    for (const convert::ExportFile& file : result.files)
      files.push_back({{"name", file.name}, {"bytes", file.bytes.size()}});
    json["files"] = std::move(files);
    json["remarks"] = result.remarks;
    json["outlets"] = Json::array();
    for (const convert::OutletRow& row : result.outlets) json["outlets"].push_back(outletJson(row));
    json["surface"] = surfaceJson(result.surface, value);
    std::string text = caseLine(m_output, value);
    for (const std::string& remark : result.remarks) text += Lines().add(remark).text();
    if (!result.outlets.empty()) text += outletLines(result.outlets);
    return {std::move(json), text + surfaceLines(result.surface, value)};
  }

  bool m_list = false;
  InputFile m_input;
  std::string m_target, m_output;
  std::optional<double> m_time;
  convert::ExportOptions m_options;
};

}  // namespace

std::unique_ptr<Command> makeExportCommand() {
  return std::make_unique<ExportCommand>();
}

}  // namespace lumen::engine
