// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/report_of.h"

#include <array>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/privacy.h"
#include "converters/base/sha256.h"
#include "converters/base/warning.h"
#include "converters/draw/overlay/overlay.h"
#include "converters/draw/picture/draw_case.h"
#include "converters/io/volume/write_volume.h"
#include "converters/judge/measure/measure_case.h"
#include "converters/operations/surface_of.h"
#include "converters/stages/tracking/tracking_volume.h"

namespace lumen::operations {

namespace {

using convert::ColorBy, convert::DrawnView, convert::ReportFacts, convert::View;

constexpr int kSideWidth = 900, kSideHeight = 600;  // pixels: 260 to an inch on paper
constexpr std::size_t kRemarksListed = 200;
constexpr std::array<std::pair<View, const char*>, 4> kSides = {{
    {View::Anterior, "anterior: from the front"},
    {View::Posterior, "posterior: from behind"},
    {View::Left, "left: from the patient's left"},
    {View::Right, "right: from the patient's right"},
}};

bool isModelled(const formats::Case& value) {
  return value.models && value.tree.nodeCount() > 0;
}

DrawnView drawnView(const std::string& title, const convert::Picture& picture) {
  return {title, convert::encodePng(picture), picture.width, picture.height};
}

/// Names of files are on the page, too.
void addNamesOfFiles(ReportFacts& facts, const std::vector<std::string>& names) {
  for (const std::string& words : names)
    for (const PrivacyFinding& finding : scanText(words, ""))
      facts.otherWarnings.push_back(std::string(finding.code) + ": a name on this page " +
                                    finding.message);
}

/// Remarks on the surface that `lumen convert` makes by default, or the reason why there is none.
std::vector<std::string> surfaceRemarks(const formats::Case& value, const Context& context) {
  try {
    std::vector<std::string> lines;
    for (const Warning& warning : surfaceWarnings(
             convert::closedSurface(value, SurfaceOptions().closed, context.progress).report, value,
             context))
      lines.push_back(warningText(warning));
    return lines;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled) throw;
    return {warningText(
        {WarningCode::SurfaceNone, std::string("there is no closed surface: ") + error.what()})};
  }
}

void addViews(ReportFacts& facts, Progress& progress) {
  const convert::CasePainter painter(facts.value);
  const auto drawn = [&](View view, ColorBy colour, const char* title) {
    convert::PictureOptions options;
    options.view = view;
    options.colour = colour;
    options.allTurns = view != View::Best;  // the sides at one scale
    options.width = kSideWidth;
    options.height = kSideHeight;
    return drawnView(title, painter.draw(options, progress));
  };
  for (const auto& [view, title] : kSides) facts.sides.push_back(drawn(view, ColorBy::None, title));
  if (!facts.value.tree.inlierRate.empty())
    facts.confidence = drawn(View::Best, ColorBy::Confidence, "");
}

void addFactsOfVolume(ReportFacts& facts, const ReportedVolume& volume, const Context& context) {
  const auto note = [&](const std::string& name, const std::optional<std::string>& words) {
    if (words) facts.otherWarnings.push_back(name + ": " + *words);
  };
  for (const std::string& assumption : volume.voxels.assumptions) note(volume.name, assumption);
  note(volume.name, convert::doubtAbout(volume.voxels));
  convert::ReportVolume& result = facts.volume.emplace();
  result.name = volume.name;
  result.geometry = convert::describeSource(volume.voxels);
  convert::CheckReport report;
  if (isModelled(facts.value)) {
    Checked made = checked(facts.value, volume.voxels, result.geometry,
                           {volume.pointSpread, {}, volume.names}, context);
    result.source = std::move(made.source);
    report = std::move(made.report);
    result.check = report;
  } else {
    result.source = relationOf(facts.value, result.geometry, volume.names, context);
    report.nodes.assign(facts.value.tree.nodeCount(), convert::Agreement::NotJudged);
  }
  note(facts.caseName, result.source.warning(volume.name));
  note(facts.caseName, convert::outsideWarning(report, volume.name));
  for (const convert::OverlayPanel& panel :
       convert::drawOverlayPanels(volume.voxels, facts.value.tree, report))
    result.projections.push_back(drawnView(panel.title, panel.picture));
}

/// Facts of the case alone.
ReportFacts factsOf(ReportedCase source, Progress& progress) {
  ReportFacts facts;
  facts.title = source.title.empty() ? source.name : std::move(source.title);
  facts.caseName = std::move(source.name);
  facts.bytes = source.file.size();
  facts.sha256 = sha256(source.file);
  facts.examination = convert::examineBytes(source.file, "", kRemarksListed, true, progress);
  facts.value = std::move(source.value);
  facts.info = convert::describeCase(facts.value, progress);
  facts.measures = convert::measureCase(facts.value, {}, progress);
  return facts;
}

}  // namespace

Page reportOf(ReportedCase source, const std::optional<ReportedVolume>& volume,
              const Context& context) {
  std::vector<std::string> names = {source.name};
  if (!source.title.empty()) names.push_back(source.title);
  if (volume) names.push_back(volume->name);
  ReportFacts facts = factsOf(std::move(source), context.progress);
  addNamesOfFiles(facts, names);
  // a volume that is given states its own
  if (!volume)
    for (const std::string& assumption : recordedAssumptions(facts.value.metadata))
      facts.otherWarnings.push_back("the volume of the case: " + assumption);
  if (isModelled(facts.value)) {
    for (const std::string& sentence : surfaceRemarks(facts.value, context))
      facts.otherWarnings.push_back("the surface that lumen convert makes: " + sentence);
    addViews(facts, context.progress);
  }
  if (volume) addFactsOfVolume(facts, *volume, context);
  std::string html = convert::reportPage(facts);
  return {std::move(html), std::move(facts)};
}

}  // namespace lumen::operations
