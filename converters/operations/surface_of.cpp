// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/surface_of.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/edit_steps.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/base/warning.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

using convert::BranchLosses;
using convert::Patches;

/// The step by which a case records warnings that a person accepted: reasons, by the codes.
constexpr const char* kAcceptStep = "accept";

std::string contactCode() {
  return std::string(warningName(WarningCode::LumenContact));
}

/// "branch "a" has", "branches "a", "b" and 7 more have".
std::string subject(const std::vector<std::string>& labels) {
  constexpr std::size_t kNamed = 5;
  std::string text = labels.size() == 1 ? "branch" : "branches";
  for (std::size_t i = 0; i < std::min(labels.size(), kNamed); ++i)
    text += (i == 0 ? " \"" : ", \"") + formats::printable(labels[i]) + "\"";
  if (labels.size() > kNamed) text += " and " + std::to_string(labels.size() - kNamed) + " more";
  return text + (labels.size() == 1 ? " has" : " have");
}

/// Two digits, rounded down.
std::string atMost(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return shownNumber(std::floor(value / unit) * unit);
}

/// Advice on losses at nodes of at least the radius `thinnest`, mm. `promise`: the effect of finer
/// cells.
std::string advice(double thinnest, double cell, const std::string& promise,
                   const Context& context) {
  const double coarsest = convert::coarsestCellFor(thinnest);
  if (cell <= coarsest)
    return "; their models do not agree on a surface there, and finer cells do not help";
  return "; cells of " + atMost(cell) + " mm are too coarse there: " + context.field("cell") + " " +
         atMost(coarsest) + " or less " + promise;
}

std::string missingText(const Patches& patches, double cell, const Context& context) {
  std::vector<std::string> coarse, bare;
  double thinnest = INFINITY;
  for (std::size_t b = 0; b < patches.losses.size(); ++b) {
    const BranchLosses& losses = patches.losses[b];
    if (losses.triangles > 0) continue;
    (losses.any() ? coarse : bare).push_back(patches.surface.labels[b]);
    if (losses.any()) thinnest = std::min(thinnest, losses.thinnest);
  }
  std::string text;
  if (!coarse.empty())
    text += subject(coarse) + " no surface in it" + advice(thinnest, cell, "keeps it", context);
  if (!bare.empty())
    text += (text.empty() ? "" : "; ") + subject(bare) +
            " no models, so no surface in it; lumen fit makes models";
  return text;
}

std::string holesText(const Patches& patches, double cell, const Context& context) {
  std::vector<std::string> torn;
  std::size_t nodes = 0, triangles = 0;
  double thinnest = INFINITY;
  for (std::size_t b = 0; b < patches.losses.size(); ++b) {
    const BranchLosses& losses = patches.losses[b];
    if (losses.triangles == 0 || !losses.any()) continue;
    torn.push_back(patches.surface.labels[b]);
    nodes += losses.missedNodes;
    triangles += losses.lostTriangles;
    thinnest = std::min(thinnest, losses.thinnest);
  }
  if (torn.empty()) return "";
  return subject(torn) + " holes (" + counted(nodes, "node", "nodes") + " without surface, " +
         counted(triangles, "triangle", "triangles") + " dropped)" +
         advice(thinnest, cell, "may close them", context);
}

Surface patchesOf(const formats::Case& value, const SurfaceOptions& options,
                  const std::string& name, const Context& context) {
  Surface result;
  convert::PolygoniseOptions patches = options.patches;
  patches.cell = convert::chooseCell(value, patches);
  for (int level = 0; level < options.closed.levels; ++level) {
    Patches made = convert::polygonise(value, patches, context.progress);
    context.progress.check();
    if (level == 0) warnOfLosses(made, name, patches.cell, context);
    result.levels.push_back(std::move(made.surface));
    patches.cell *= 2;
  }
  return result;
}

}  // namespace

std::optional<std::string> acceptedContacts(const formats::Metadata& metadata) {
  const auto& steps = metadata.steps;
  if (steps.empty() || steps.back().name != kAcceptStep) return {};
  const auto found = steps.back().parameters.find(contactCode());
  if (found == steps.back().parameters.end()) return {};
  return parameterText(found->second);
}

void acceptContacts(formats::Metadata& metadata, const std::string& reason) {
  if (reason.find_first_not_of(' ') == std::string::npos)
    throw Error(ErrorKind::Usage, "places are accepted for a reason: state one");
  if (acceptedContacts(metadata)) metadata.steps.pop_back();
  addStep(metadata, {kAcceptStep, "lumen " LUMEN_VERSION, {{contactCode(), reason}}});
}

std::vector<Warning> surfaceWarnings(const convert::SurfaceReport& report,
                                     const formats::Case& value, const Context& context) {
  std::vector<Warning> out;
  for (const std::string& message : report.messages)
    out.push_back({WarningCode::SurfaceEnd, message});
  if (report.openedEdges > 0)
    out.push_back({WarningCode::SurfaceOpened,
                   counted(report.openedEdges, "edge", "edges") +
                       " of the tree had no lumen and were opened in the mesh",
                   "lumen fit opens models"});
  if (report.crossings > 0)
    out.push_back(
        {WarningCode::SurfaceCrossing,
         counted(report.crossings, "pair of triangles passes", "pairs of triangles pass") +
             " through each other",
         "a greater " + context.field("gap") + " or a smaller " + context.field("edge") +
             " may help"});
  if (!report.cuts.empty() && !acceptedContacts(value.metadata))
    out.push_back(
        {WarningCode::LumenContact,
         "the lumen runs into itself" +
             (report.cuts.size() == 1 ? ""
                                      : " at " + std::to_string(report.cuts.size()) + " places") +
             " without a link, and is cut there",
         "if two tracks are in one vessel there, delete one in lumen view; if two vessels "
         "touch, the cut keeps them apart, as they are, which lumen info records as accepted",
         report.cuts});
  return out;
}

void warnOfLosses(const Patches& patches, const std::string& name, double cell,
                  const Context& context) {
  for (const std::string& text :
       {missingText(patches, cell, context), holesText(patches, cell, context)})
    if (!text.empty())
      warn(context.progress, about(formats::printable(name), {WarningCode::SurfaceHoles, text}));
}

Surface surfaceOf(const formats::Case& value, const SurfaceOptions& options,
                  const std::string& name, const Context& context) {
  if (options.isInPatches) return patchesOf(value, options, name, context);
  convert::ClosedSurface made = convert::closedSurface(value, options.closed, context.progress);
  for (const Warning& warning : surfaceWarnings(made.report, value, context))
    warn(context.progress, about(formats::printable(name), warning));
  return {std::move(made.levels), std::move(made.report)};
}

}  // namespace lumen::operations
