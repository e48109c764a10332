// SPDX-License-Identifier: Apache-2.0
// lumen report: a case as a page to print.
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/options/edit_steps.h"
#include "converters/base/options/option_name.h"
#include "converters/base/privacy.h"
#include "converters/base/sha256.h"
#include "converters/draw/overlay/overlay.h"
#include "converters/draw/picture/draw_case.h"
#include "converters/draw/report/report_page.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/surface_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"
#include "converters/engine/scope.h"
#include "converters/engine/stage_options.h"
#include "converters/engine/tracking_input.h"
#include "converters/io/volume/write_volume.h"
#include "converters/judge/check/check.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using convert::DrawnView, convert::ReportFacts, convert::ReportVolume, convert::View;

constexpr int kSideWidth = 900, kSideHeight = 600;  // pixels: 260 to an inch on paper
constexpr std::size_t kRemarksListed = 200;
constexpr std::array<std::pair<View, const char*>, 4> kSides = {{
    {View::Anterior, "anterior: from the front"},
    {View::Posterior, "posterior: from behind"},
    {View::Left, "left: from the patient's left"},
    {View::Right, "right: from the patient's right"},
}};

std::string nameOf(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

DrawnView viewOf(const std::string& title, const convert::Picture& picture) {
  return {title, convert::encodePng(picture), picture.width, picture.height};
}

DrawnView drawn(const formats::Case& value, View view, convert::ColorBy colour, const char* title,
                Progress& progress) {
  convert::PictureOptions options;
  options.view = view;
  options.colour = colour;
  options.allTurns = view != View::Best;  // the sides at one scale
  options.width = kSideWidth;
  options.height = kSideHeight;
  return viewOf(title, convert::drawCase(value, options, nullptr, progress));
}

/// An empty check, for the projections of a case that has no wall to judge.
convert::CheckReport nothingJudged(const formats::CenterlineTree& tree) {
  convert::CheckReport report;
  report.nodes.assign(tree.nodeCount(), convert::Agreement::NotJudged);
  return report;
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
    ReportFacts facts = factsOfCase(context);
    const OptionRow& spread = *context.table->find("point-spread");
    if (spread.isGiven && !facts.value.models)
      refuseUnused(spread,
                   "is for cases with models, and " + formats::printable(m_case) + " has none",
                   context.progress);
    if (!m_input.empty()) addVolume(facts, context.progress);
    if (const std::size_t count = facts.warnings(); count > 0)
      context.progress.warn(m_case + ": " + counted(count, "warning", "warnings") +
                            ", which the page lists");
    const std::string page = convert::reportPage(facts);
    writeText(page, m_output);
    return report(facts, page.size());
  }

private:
  /// Refuses outputs that could not be written in the end, or would be lost.
  void checkNames(const RunContext& context) const {
    if (!m_output.ends_with(".html") && !m_output.ends_with(".htm"))
      throw Error(ErrorKind::Usage,
                  formats::printable(m_output) +
                      ": found a name without .html, expected one with it; a browser "
                      "prints the page as PDF");
    requireInScope(*context.table, {}, context.progress);
    if (!m_input.empty()) {
      requireInput(m_input, "volume");
      const FileFormat& from = inputFormat(m_input, m_from);
      if (from.kind != FormatKind::Volume)
        throw unsupported(m_input + ": this is a " +
                          (from.kind == FormatKind::Mesh ? "mesh" : "case") + "; " +
                          kOption.volume.shown() + " takes the volume that the case was made from");
      requireInScope(*context.table, {inputContent(from, false), kAnyContent, m_input, {}},
                     context.progress);
    }
    requireWritable(m_output, convert::ContentKind::Other);
  }

  [[nodiscard]] ReportFacts factsOfCase(const RunContext& context) const {
    Progress& progress = context.progress;
    ReportFacts facts;
    auto [bytes, value] = readCaseAndBytes(m_case);
    facts.caseName = nameOf(m_case);
    facts.title = m_title.empty() ? facts.caseName : m_title;
    facts.bytes = bytes.size();
    facts.sha256 = sha256(bytes);
    facts.examination = convert::examineBytes(bytes, m_case, kRemarksListed, true, progress);
    facts.value = atTime(std::move(value), m_time, m_case, *context.table, progress);
    facts.info = convert::describeCase(facts.value, progress);
    facts.measures = convert::measureCase(facts.value, {}, progress);
    addNames(facts);
    // a volume that is given states its own
    if (m_input.empty())
      for (const std::string& assumption : recordedAssumptions(facts.value.metadata))
        facts.otherWarnings.push_back("the volume of the case: " + assumption);
    if (!facts.value.models || facts.value.tree.nodeCount() == 0) return facts;
    for (const std::string& sentence : examineSurface(facts.value, progress).warnings)
      facts.otherWarnings.push_back("the surface that lumen convert makes: " + sentence);
    for (const auto& [view, title] : kSides)
      facts.sides.push_back(drawn(facts.value, view, convert::ColorBy::None, title, progress));
    if (!facts.value.tree.inlierRate.empty())
      facts.confidence = drawn(facts.value, View::Best, convert::ColorBy::Confidence, "", progress);
    return facts;
  }

  /// The page shows names of files, too.
  void addNames(ReportFacts& facts) const {
    std::vector<std::string> names = {facts.caseName};
    if (!m_title.empty()) names.push_back(m_title);
    if (!m_input.empty()) names.push_back(nameOf(m_input));
    for (const std::string& words : names)
      for (const PrivacyFinding& finding : scanText(words, ""))
        facts.otherWarnings.push_back(std::string(finding.code) + ": a name on this page " +
                                      finding.message);
  }

  void addVolume(ReportFacts& facts, Progress& progress) const {
    const std::string name = nameOf(m_input);
    const convert::Volume volume =
        loadVolume(m_input, inputFormat(m_input, m_from), m_volume, progress);
    for (const std::string& assumption : volume.assumptions)
      facts.otherWarnings.push_back(name + ": " + assumption);
    if (const auto doubt = convert::doubtAbout(volume))
      facts.otherWarnings.push_back(name + ": " + *doubt);
    ReportVolume& result = facts.volume.emplace();
    result.name = name;
    result.geometry = convert::describeSource(volume);
    result.source = convert::sourceRelation(result.geometry, facts.value.metadata);
    warn(facts, result.source.warning(name), progress);
    if (facts.value.models && facts.value.tree.nodeCount() > 0) {
      result.check = checked(volume, facts.value, progress);
      warn(facts, convert::outsideWarning(*result.check, name), progress);
    }
    const convert::CheckReport& report =
        result.check ? *result.check : nothingJudged(facts.value.tree);
    for (const convert::OverlayPanel& panel :
         convert::drawOverlayPanels(volume, facts.value.tree, report))
      result.projections.push_back(viewOf(panel.title, panel.picture));
  }

  void warn(ReportFacts& facts, const std::optional<std::string>& words, Progress& progress) const {
    if (!words) return;
    facts.otherWarnings.push_back(facts.caseName + ": " + *words);
    progress.warn(m_case + ": " + *words);
  }

  [[nodiscard]] convert::CheckReport checked(const convert::Volume& volume,
                                             const formats::Case& value, Progress& progress) const {
    convert::EdgeOptions options = convert::recordedEdgeOptions(value);
    if (m_pointSpread) options.pointSpread = *m_pointSpread;
    try {
      return convert::checkCase(volume, value, options, progress).report;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::InvalidInput) throw;
      throw invalidInput(m_case + " and " + m_input + ": " + error.what());
    }
  }

  [[nodiscard]] Answer report(const ReportFacts& facts, std::size_t bytes) const {
    Json json;
    json["file"] = m_output;
    json["bytes"] = bytes;
    json["case_sha256"] = facts.sha256;
    json["branches"] = facts.value.tree.branches.size();
    json["pictures"] = facts.sides.size() + (facts.confidence ? 1 : 0) +
                       (facts.volume ? facts.volume->projections.size() : 0);
    json["source"] = facts.volume ? Json(facts.volume->source.word()) : Json(nullptr);
    json["warnings"] = facts.warnings();
    return {
        std::move(json),
        formats::printable(m_output) + ": " +
            counted(facts.value.tree.branches.size(), "branch", "branches") + ", " +
            counted(facts.warnings(), "warning", "warnings") + ", " + std::to_string(bytes) +
            " bytes" +
            (facts.volume ? "" : "; without " + kOption.volume.shown() + " nothing of the volume") +
            "\n"};
  }

  std::string m_case, m_output, m_input, m_title, m_from;
  std::optional<double> m_pointSpread, m_time;
  VolumeArguments m_volume;
};

}  // namespace

std::unique_ptr<Command> makeReportCommand() {
  return std::make_unique<ReportCommand>();
}

}  // namespace lumen::engine
