// SPDX-License-Identifier: Apache-2.0
// lumen validate: all that is wrong in case files.
#include "converters/app/command.h"
#include "converters/app/report.h"
#include "formats/case/case_file.h"

namespace lumen::app {

namespace {

using formats::FormatError;
using formats::ValidationReport;

constexpr int kInvalid = 3;

int numberOf(const FormatError& issue) {
  for (const auto& rule : formats::errorRules())
    if (issue.code == rule.name) return static_cast<int>(rule.code);
  return 0;
}

Json issueJson(const FormatError& issue) {
  Json arguments = Json::object();
  for (const auto& argument : issue.arguments) arguments[argument.name] = argument.value;
  Json json;
  json["code"] = issue.code;
  json["number"] = numberOf(issue);
  json["severity"] = formats::severityName(issue.severity);
  json["offset"] = issue.offset ? Json(*issue.offset) : Json(nullptr);
  json["pointer"] = issue.pointer ? Json(*issue.pointer) : Json(nullptr);
  json["arguments"] = std::move(arguments);
  json["message"] = issue.message;
  return json;
}

Json reportJson(const std::string& file, const ValidationReport& report) {
  Json json;
  json["file"] = file;
  json["valid"] = report.valid();
  json["complete"] = report.complete;
  json["issues"] = Json::array();
  for (const FormatError& issue : report.issues) json["issues"].push_back(issueJson(issue));
  return json;
}

std::string reportText(const std::string& file, const ValidationReport& report) {
  std::string text;
  for (const FormatError& issue : report.issues)
    text.append(file)
        .append(": ")
        .append(formats::severityName(issue.severity))
        .append(" ")
        .append(issue.text() + "\n");
  if (!report.complete) text.append(file).append(": --max-issues reached, there may be more\n");
  return text.append(file).append(report.valid() ? ": valid\n" : ": not valid\n");
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
        ->configurable(false);
    app.add_option("--max-issues", m_options.maxIssues, "Stop at so many issues in a file")
        ->type_name("N")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}).description(""))
        ->capture_default_str();
    app.add_flag("--privacy", m_options.privacy,
                 "Also look in labels, notes and parameters for persons, dates and paths");
  }

  int run(Context& context) override {
    bool valid = true;
    Json files = Json::array();
    for (const std::string& file : m_files) {
      context.progress.check();
      const ValidationReport report = formats::validateFile(file, m_options);
      valid = valid && report.valid();
      if (context.common.json)
        files.push_back(reportJson(file, report));
      else if (!context.common.quiet || !report.valid())
        answer(reportText(file, report));
    }
    if (context.common.json) answerJson({{"valid", valid}, {"files", std::move(files)}});
    return valid ? 0 : kInvalid;
  }

private:
  std::vector<std::string> m_files;
  formats::ValidateOptions m_options;
};

}  // namespace

std::unique_ptr<Command> makeValidateCommand() {
  return std::make_unique<ValidateCommand>();
}

}  // namespace lumen::app
