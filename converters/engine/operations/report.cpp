// SPDX-License-Identifier: Apache-2.0
// lumen report: a case as a page to print.
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "converters/base/options/option_name.h"
#include "converters/base/warning.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/operations/report_of.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

std::string nameOf(const InputFile& file) {
  return file.path().filename().string();
}

class ReportCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "report"; }
  [[nodiscard]] std::string summary() const override {
    return "Write all about a case as one page to print: pictures, tables, plots";
  }
  [[nodiscard]] std::string example() const override {
    return "  lumen report head.lumen head.html --volume head.nrrd";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_case, "Case");
    table.argument("HTML", &m_output, "Page to write: one file, which needs no network");
    table.file(
        kOption.volume.name, m_input,
        "Volume that the case was made from: also its projections, and how far the case agrees "
        "with it, as lumen check reports");
    table.add("title", &m_title, "NAME", "Title of the page [the name of CASE]");
    addTimeRow(table, m_time);
    table
        .add("point-spread", &m_pointSpread, "MM",
             "Blur of the volume, a standard deviation in mm, as for lumen check [what the "
             "case records, else 0]")
        .in(NumberRange{0, 1000})
        .onlyWith(kOption.volume.name);
    addFormatRow(table, "from", m_from, "the volume");
    table.find("from")->onlyWith(kOption.volume.name);
    addVolumeRows(table, m_volume, kOption.volume.name);
  }

  Answer run(const RunContext& context) override {
    checkNames(context);
    auto [bytes, value] = readCaseAndBytes(m_case);
    value = atTime(std::move(value), m_time, m_case.name(), *context.table, context.progress);
    const OptionRow& spread = *context.table->find("point-spread");
    if (spread.isGiven && !value.models)
      refuseUnused(
          spread,
          "is for cases with models, and " + formats::printable(m_case.name()) + " has none",
          context.progress);
    const operations::Page page =
        operations::reportOf({std::move(value), bytes, nameOf(m_case), m_title},
                             reportedVolume(context.progress), operationContext(context));
    if (const std::size_t count = page.facts.warnings(); count > 0)
      warn(context.progress, about(m_case.name(), {WarningCode::ReportWarnings,
                                                   counted(count, "warning", "warnings") +
                                                       ", which the page lists"}));
    writeText(page.html, m_output);
    return report(page.facts, page.html.size());
  }

private:
  /// Refuses outputs that could not be written in the end, or would be lost.
  void checkNames(const RunContext& context) const {
    const std::string ending = m_output.path().extension().string();
    if (ending != ".html" && ending != ".htm")
      throw Error(ErrorKind::Usage,
                  formats::printable(m_output.name()) +
                      ": found a name without .html, expected one with it; a browser "
                      "prints the page as PDF");
    requireInScope(*context.table, {}, context.progress);
    if (!m_input.empty()) {
      requireInput(m_input, "volume");
      const FileFormat& from = inputFormat(m_input, m_from);
      if (from.kind != FormatKind::Volume)
        throw unsupported(m_input.name() + ": this is a " +
                          (from.kind == FormatKind::Mesh ? "mesh" : "case") + "; " +
                          kOption.volume.shown() + " takes the volume that the case was made from");
      requireInScope(*context.table, {inputContent(from, false), kAnyContent, m_input.name(), {}},
                     context.progress);
    }
    requireWritable(m_output, convert::ContentKind::Other);
  }

  [[nodiscard]] std::optional<operations::ReportedVolume> reportedVolume(Progress& progress) const {
    if (m_input.empty()) return std::nullopt;
    const std::string name = nameOf(m_input);
    return operations::ReportedVolume{
        loadVolume(m_input, inputFormat(m_input, m_from), m_volume, progress), name, m_pointSpread,
        operations::CheckNames{m_case.name(), name, m_case.name() + " and " + m_input.name()}};
  }

  [[nodiscard]] Answer report(const convert::ReportFacts& facts, std::size_t bytes) const {
    Json json;
    json["file"] = m_output.name();
    json["bytes"] = bytes;
    json["case_sha256"] = facts.sha256;
    json["branches"] = facts.value.tree.branches.size();
    json["pictures"] = facts.sides.size() + (facts.confidence ? 1 : 0) +
                       (facts.volume ? facts.volume->projections.size() : 0);
    json["source"] = facts.volume ? Json(facts.volume->source.word()) : Json(nullptr);
    json["warnings"] = facts.warnings();
    return {
        std::move(json),
        formats::printable(m_output.name()) + ": " +
            counted(facts.value.tree.branches.size(), "branch", "branches") + ", " +
            counted(facts.warnings(), "warning", "warnings") + ", " + std::to_string(bytes) +
            " bytes" +
            (facts.volume ? "" : "; without " + kOption.volume.shown() + " nothing of the volume") +
            "\n"};
  }

  InputFile m_case, m_input;
  OutputFile m_output;
  std::string m_title, m_from;
  std::optional<double> m_pointSpread, m_time;
  VolumeArguments m_volume;
};

}  // namespace

std::unique_ptr<Command> makeReportCommand() {
  return std::make_unique<ReportCommand>();
}

}  // namespace lumen::engine
