// SPDX-License-Identifier: Apache-2.0
// lumen validate: all faults of case files.
#include <optional>
#include <utility>

#include "converters/base/options/option_name.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/judge/facts/examination.h"

namespace lumen::engine {

namespace {

constexpr int kSurface = 652;  // not a rule of the format: see spec/errors.md

/// A remark on the closed surface of a case.
convert::Remark surfaceRemark(formats::Severity severity, const std::string& sentence) {
  convert::Remark remark;
  remark.code = "SURFACE";
  remark.number = kSurface;
  remark.severity = formats::severityName(severity);
  remark.message = sentence;
  remark.text = remark.code + " at file: " + sentence;
  return remark;
}

Json remarkJson(const convert::Remark& remark) {
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

Json reportJson(const std::string& file, const convert::FileReport& report) {
  Json json;
  json["file"] = file;
  json["valid"] = report.valid;
  json["complete"] = report.unlisted() == 0;
  json["errors"] = report.counts.errors;
  json["warnings"] = report.counts.warnings;
  json["information"] = report.counts.information;
  json["issues"] = Json::array();
  for (const convert::Remark& remark : report.remarks) json["issues"].push_back(remarkJson(remark));
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

std::string reportText(const std::string& file, const convert::FileReport& report) {
  Lines lines;
  for (const convert::Remark& remark : report.remarks)
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
    return "Report all faults of case files; exit with 3 if there are any";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen validate head.lumen head.lumen.json --privacy\n"
           "  lumen validate head.lumen --surface";
  }

  void addRows(OptionTable& table) override {
    table.argument("FILE", &m_files, "Cases, .lumen or .lumen.json").many();
    table
        .add("max-issues", &m_maxIssues, "N",
             "Report at most N issues of a file, errors first; all are counted")
        .in(WholeRange{0, 1000000});
    table.flag(kOption.privacy.name, m_privacy,
               "Also warn of texts that may identify a patient, such as dates and names");
    table.flag("surface", m_surface,
               "Also make the closed surface that lumen convert makes, and report its warnings: "
               "branches left out, triangles that pass through each other. It takes as long as "
               "the mesh: seconds for most cases");
  }

  Answer run(const RunContext& context) override {
    bool valid = true, personal = false, warned = false;
    Json files = Json::array();
    for (const InputFile& file : m_files) {
      context.progress.check();
      convert::FileReport report = convert::examine(file, m_maxIssues, m_privacy, context.progress);
      if (m_surface && report.valid) addSurface(file, report, context.progress);
      report.refusedByStrict = context.strict && report.valid && report.counts.warnings > 0;
      if (report.refusedByStrict) report.valid = false;
      valid = valid && report.valid;
      personal = personal || report.personal;
      warned = warned || report.counts.warnings > 0;
      files.push_back(reportJson(file.name(), report));
      context.answerEarly(
          {{}, reportText(file.name(), report), 0, !report.valid || report.personal});
    }
    const bool passes = valid && !personal && !(warned && context.strict);
    return {{{"valid", valid}, {"files", std::move(files)}}, "", passes ? 0 : kInvalidCode};
  }

private:
  void addSurface(const InputFile& file, convert::FileReport& report, Progress& progress) const {
    const formats::Case value = readCase(file);
    if (!value.models) {
      ++report.counts.information;
      if (report.remarks.size() < m_maxIssues)
        report.remarks.push_back(surfaceRemark(
            formats::Severity::Information,
            "the case has no models, so there is no closed surface; lumen fit makes them"));
      return;
    }
    for (const Warning& warning : examineSurface(value, progress).warnings) {
      ++report.counts.warnings;
      if (report.remarks.size() < m_maxIssues)
        report.remarks.push_back(surfaceRemark(formats::Severity::Warning, warningText(warning)));
    }
  }

  std::vector<InputFile> m_files;
  std::size_t m_maxIssues = formats::kDefaultMaxIssues;
  bool m_privacy = false, m_surface = false;
};

}  // namespace

std::unique_ptr<Command> makeValidateCommand() {
  return std::make_unique<ValidateCommand>();
}

}  // namespace lumen::engine
