// SPDX-License-Identifier: Apache-2.0
// lumen validate: all that is wrong in case files.
#include <optional>
#include <utility>

#include "converters/cli/command.h"
#include "converters/cli/value_checks.h"
#include "converters/engine/examination.h"
#include "converters/engine/report.h"
#include "formats/case/case_file.h"

namespace lumen::app {

namespace {

constexpr int kInvalid = 3;

Json remarkJson(const Remark& remark) {
  Json arguments = Json::object();
  for (const auto& argument : remark.arguments) arguments[argument.name] = argument.value;
  Json json;
  json["code"] = remark.code;
  json["number"] = remark.number;
  json["severity"] = remark.severity;
  json["offset"] = remark.offset ? Json(*remark.offset) : Json(nullptr);
  json["pointer"] = remark.pointer ? Json(*remark.pointer) : Json(nullptr);
  json["arguments"] = std::move(arguments);
  json["message"] = remark.message;
  return json;
}

Json reportJson(const std::string& file, const FileReport& report) {
  Json json;
  json["file"] = file;
  json["valid"] = report.valid;
  json["complete"] = report.unlisted() == 0;
  json["errors"] = report.counts.errors;
  json["warnings"] = report.counts.warnings;
  json["information"] = report.counts.information;
  json["issues"] = Json::array();
  for (const Remark& remark : report.remarks) json["issues"].push_back(remarkJson(remark));
  return json;
}

/// "2 errors, 1 warning and 150 notes", without those that there are none of.
std::string countsText(const formats::IssueCounts& counts) {
  std::vector<std::string> parts;
  if (counts.errors > 0) parts.push_back(counted(counts.errors, "error", "errors"));
  if (counts.warnings > 0) parts.push_back(counted(counts.warnings, "warning", "warnings"));
  if (counts.information > 0) parts.push_back(counted(counts.information, "note", "notes"));
  std::string text = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i)
    text += (i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

std::string reportText(const std::string& file, const FileReport& report) {
  Lines lines;
  for (const Remark& remark : report.remarks)
    lines.add(file + ": " + remark.severity + " " + remark.text);
  if (report.unlisted() > 0)
    lines.add(file + ": " + countsText(report.counts) + ", " +
              std::to_string(report.remarks.size()) + " of them listed; --max-issues N lists more");
  const char* verdict = report.valid             ? ": valid"
                        : report.refusedByStrict ? ": not valid, as --strict makes warnings errors"
                                                 : ": not valid";
  return lines.add(file + verdict).text();
}

class ValidateCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "validate"; }
  [[nodiscard]] std::string summary() const override {
    return "Tell all that is wrong in case files; exit with 3 if anything is";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen validate head.lumen head.lumen.json --privacy";
  }

  void bind(CLI::App& app) override {
    app.add_option("FILE", m_files, "Cases, .lumen or .lumen.json")
        ->required()
        ->check(fileName())
        ->configurable(false);
    app.add_option("--max-issues", m_maxIssues,
                   "List so many issues of a file, errors first; all count for the verdict")
        ->type_name("N")
        ->check(wholeIn(0, 1000000))
        ->capture_default_str();
    app.add_flag("--privacy", m_privacy,
                 "Also warn of texts that may tell who a patient is, such as dates and names");
  }

  int run(Context& context) override {
    bool valid = true, personal = false, warned = false;
    Json files = Json::array();
    for (const std::string& file : m_files) {
      context.progress.check();
      FileReport report = examine(file, m_maxIssues, m_privacy, context.progress);
      report.refusedByStrict = context.common.strict && report.valid && report.counts.warnings > 0;
      if (report.refusedByStrict) report.valid = false;
      valid = valid && report.valid;
      personal = personal || report.personal;
      warned = warned || report.counts.warnings > 0;
      if (context.common.json)
        files.push_back(reportJson(file, report));
      else if (!context.common.quiet || !report.valid || report.personal)
        answer(reportText(file, report));
    }
    if (context.common.json) answerJson({{"valid", valid}, {"files", std::move(files)}});
    return valid && !personal && !(warned && context.common.strict) ? 0 : kInvalid;
  }

private:
  std::vector<std::string> m_files;
  std::size_t m_maxIssues = formats::kDefaultMaxIssues;
  bool m_privacy = false;
};

}  // namespace

std::unique_ptr<Command> makeValidateCommand() {
  return std::make_unique<ValidateCommand>();
}

}  // namespace lumen::app
