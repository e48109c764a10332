// SPDX-License-Identifier: Apache-2.0
// lumen export: a case as the folder of files that a simulator loads.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "converters/app/command.h"
#include "converters/app/export_options.h"
#include "converters/app/export_target.h"
#include "converters/app/file_access.h"
#include "converters/app/reachable.h"
#include "converters/app/report.h"
#include "converters/app/surface_report.h"
#include "converters/app/value_checks.h"
#include "converters/common/error.h"
#include "formats/case/atomic_file.h"

namespace lumen::app {

namespace fs = std::filesystem;

namespace {

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

std::vector<std::string> targetNames() {
  std::vector<std::string> names;
  for (const ExportTarget& target : exportTargets()) names.emplace_back(target.name);
  return names;
}

/// All of them in a new folder, which appears when it is complete.
void writeFolder(const std::vector<NamedFile>& files, formats::PendingFolder& folder) {
  for (const NamedFile& file : files) {
    const fs::path path = folder.path() / file.name;
    fs::create_directories(path.parent_path());
    std::ofstream out(path, std::ios::binary);
    out.write(file.bytes.data(), static_cast<std::streamsize>(file.bytes.size()));
    out.close();
    if (!out) throw failed(path.string() + ": cannot write this file");
  }
  const auto done = folder.commit();
  if (!done) throw failed(done.error().message);
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
           "  lumen export --list";
  }

  void bind(CLI::App& app) override {
    CLI::Option* const list =
        app.add_flag("--list", m_list, "Tell the targets, their files, units and frames, and end");
    app.add_option("TARGET", m_target, "Who reads the folder: " + joinedNames())->excludes(list);
    addFile(app, "CASE", m_input, "Case, with models")->required(false)->excludes(list);
    addFile(app, "FOLDER", m_output, "Folder to write; it may not exist, or must be empty")
        ->required(false)
        ->excludes(list);
    addExportOptions(app, m_options);
    m_app = &app;
  }

  int run(Context& context) override {
    if (m_list) return list(context);
    if (m_output.empty())
      throw Error(ErrorKind::Usage, std::string(m_target.empty()  ? "TARGET"
                                                : m_input.empty() ? "CASE"
                                                                  : "FOLDER") +
                                        " is missing; usage: lumen export TARGET CASE FOLDER");
    const ExportTarget& target = exportTarget(m_target);
    refuseOptionsOfOthers(target);
    requireRoom();
    const formats::Case value = readCase(m_input);
    if (!value.models)
      throw invalidInput(m_input + ": this case has no models, so there is no wall to export; " +
                         "lumen fit makes them");
    auto folder =
        formats::PendingFolder::beside(m_output, formats::PendingFolder::Existing::Refuse);
    if (!folder) throw failed(folder.error().message);
    context.interrupts.watchOutput(m_output);
    warnOfClosed(reachOf(value, context.progress), context.progress);
    const ExportResult result = target.write(value, m_output, m_options, context.progress);
    context.progress.check();
    writeFolder(result.files, *folder);
    report(result, value, context);
    return 0;
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
    for (const std::string& name : targetNames()) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  /// An option that the target would pass over in silence.
  void refuseOptionsOfOthers(const ExportTarget& target) const {
    for (const ExportTarget& other : exportTargets())
      for (const std::string_view option : other.options) {
        const bool isOwn =
            std::find(target.options.begin(), target.options.end(), option) != target.options.end();
        if (!isOwn && m_app->count(std::string(option)) > 0)
          throw Error(ErrorKind::Usage, std::string(option) + " is for " + std::string(other.name) +
                                            ", not for " + std::string(target.name));
      }
  }

  static int list(const Context& context) {
    Json targets = Json::array();
    std::string text;
    for (const ExportTarget& target : exportTargets()) {
      targets.push_back({{"name", target.name},
                         {"title", target.title},
                         {"files", target.files},
                         {"unit", target.unit},
                         {"frame", target.frame},
                         {"holds", target.holds},
                         {"lacks", target.lacks},
                         {"options", target.options}});
      text += (text.empty() ? "" : "\n") +
              Lines()
                  .add(target.name, target.title)
                  .add("files", joined(target.files))
                  .add("unit, frame", std::string(target.unit) + ", " + std::string(target.frame))
                  .add("holds", target.holds)
                  .add("lacks", target.lacks)
                  .add("options", joined(target.options))
                  .text();
    }
    if (context.common.json)
      answerJson(Json{{"targets", std::move(targets)}});
    else
      answer(text);
    return 0;
  }

  void report(const ExportResult& result, const formats::Case& value,
              const Context& context) const {
    if (context.common.json) {
      Json json = caseSummary(value);
      json["target"] = m_target;
      Json files = Json::array();
      for (const NamedFile& file : result.files)
        files.push_back({{"name", file.name}, {"bytes", file.bytes.size()}});
      json["files"] = std::move(files);
      json["remarks"] = result.remarks;
      json["surface"] = surfaceJson(result.surface, value);
      answerJson(json);
    } else if (!context.common.quiet) {
      std::string text = caseLine(m_output, value);
      for (const std::string& remark : result.remarks) text += Lines().add(remark).text();
      answer(text + surfaceLines(result.surface, value));
    }
  }

  bool m_list = false;
  std::string m_target, m_input, m_output;
  ExportOptions m_options;
  const CLI::App* m_app = nullptr;
};

}  // namespace

std::unique_ptr<Command> makeExportCommand() {
  return std::make_unique<ExportCommand>();
}

}  // namespace lumen::app
