// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/export_options.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/text.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/mesh_options.h"
#include "converters/engine/scope.h"
#include "formats/container/printable.h"

namespace lumen::engine {

namespace {

using convert::InstrumentKind;
using convert::SofaDialect;
using convert::WallKind;

const std::map<std::string, InstrumentKind> kInstruments = {
    {"guidewire", InstrumentKind::Guidewire},
    {"catheter", InstrumentKind::Catheter},
    {"coil", InstrumentKind::Coil}};
const std::map<std::string, WallKind> kWalls = {{"mesh", WallKind::Mesh},
                                                {"implicit", WallKind::Implicit},
                                                {"grid", WallKind::Grid},
                                                {"soft", WallKind::Soft}};
const std::map<std::string, SofaDialect> kDialects = {{"current", SofaDialect::Current},
                                                      {"v23.06", SofaDialect::V23_06}};

const std::map<std::string, convert::GridFormat> kGridFormats = {
    {"nrrd", convert::GridFormat::Nrrd},
    {"nifti", convert::GridFormat::Nifti},
    {"mhd", convert::GridFormat::Mhd},
    {"vdb", convert::GridFormat::Vdb},
    {"cdf", convert::GridFormat::Cdf}};

const std::map<std::string, convert::FoamGrain> kGrains = {{"coarse", convert::FoamGrain::Coarse},
                                                           {"medium", convert::FoamGrain::Medium},
                                                           {"fine", convert::FoamGrain::Fine},
                                                           {"prisms", convert::FoamGrain::Prisms}};
const std::map<std::string, convert::FoamFlow> kFlows = {
    {"steady", convert::FoamFlow::Steady}, {"pulsatile", convert::FoamFlow::Pulsatile}};

const std::map<std::string, convert::LengthUnit> kUnits = {{"mm", convert::LengthUnit::Millimetre},
                                                           {"cm", convert::LengthUnit::Centimetre},
                                                           {"m", convert::LengthUnit::Metre}};
const std::map<std::string, convert::Axes> kUp = {{"z", convert::Axes::Lps},
                                                  {"y", convert::Axes::Lsa}};

void addSofaRows(OptionTable& table, convert::ExportOptions& options) {
  convert::SofaOptions& sofa = options.sofa;
  table.group("SOFA");
  table.choice("instrument", sofa.instrument, kInstruments,
               "Instrument that is inserted; a guidewire lies within a catheter");
  table.choice(
      "wall", sofa.wall, kWalls,
      "Wall that it touches: triangles, the models by the plugin LumenSofa, distances on a "
      "grid, or the models of vessels that give way (soft), by LumenSofa");
  table.choice("dialect", sofa.dialect, kDialects, "Version of SOFA");
  table.add("step", &sofa.step, "MM", "Distance that it advances in 0.01 s")
      .in(NumberRange{0.001, 1});
  table.add("insert", &options.insert, "LABEL",
            "Branch at whose beginning it is inserted [the root]");
}

void addFlowRows(OptionTable& table, convert::ExportOptions& options) {
  table.group("Flow");
  table
      .add("inlets", &options.inlets, "LABEL",
           "Branches of roots through which blood comes in, each with its mean flow in ml/s if it "
           "is known, as in ICA=4.2; parts of the case that no inlet leads to are left out [roots "
           "at the volume's border, 20 cm/s]")
      .many()
      .delimiter = ',';
  table.flag(
      "keep-ends", options.keepEnds,
      "Keep the ends of vessels as they are: by default tapers (tips thinner than 0.7 of the "
      "vessel by them) and stubs (shorter than they are wide, within the volume) are left out");
  table.choice(
      "cells", options.foam.cells, kGrains,
      "Cells of the mesh: 6, 9 or 14 across each vessel, and 0.3, 1.2 or 5 million at most, by "
      "snappyHexMesh; or layers of prisms and tetrahedra, by lumen");
  addLayerRows(table, options.volume);
  table.choice("flow", options.foam.flow, kFlows,
               "Flow at the ends: its mean, or two cycles of the heart");
}

void setFormats(convert::GridOptions& grid, const std::vector<std::string>& words) {
  grid.formats.clear();
  for (const std::string& word : words) grid.formats.push_back(kGridFormats.at(word));
}

void addGridRows(OptionTable& table, convert::ExportOptions& options) {
  convert::GridOptions& grid = options.grid;
  std::vector<std::string> formats;
  for (const auto& entry : kGridFormats) formats.push_back(entry.first);
  table.group("Grid");
  table
      .add("grid", &options.spacing, "MM",
           "Distance between the samples of a grid; 0: by the size of the vessels")
      .in(kNotNegative);
  OptionRow& format = table.add(
      "format", [&grid](const std::vector<std::string>& words) { setFormats(grid, words); }, "WORD",
      "File formats, one or more: " + alternatives(formats));
  format.among(formats).defaults("nrrd").many().delimiter = ',';
  table
      .add("band", &grid.band, "MM",
           "Distance from the wall beyond which values are clamped, or left out [everywhere; vdb: "
           "3 samples]")
      .in(kPositive);
  table.flag("half", grid.half, "vdb: distances of 16 bits").onlyWith("format", "vdb");
  table.flag("per-branch", grid.perBranch,
             "A grid for each branch and its neighbourhood along the tree, instead of one, in "
             "which vessels that touch are merged");
  table.flag("exact", grid.exact,
             "Distances to the nearest point of the wall in the lumen, too, with a kink at its "
             "axis, instead of libblob's, which are smooth, and right to first order");
}

template <class Value>
void addOptionalChoice(OptionTable& table, const std::string& name, std::optional<Value>& value,
                       const std::map<std::string, Value>& words, const std::string& help) {
  std::vector<std::string> names;
  for (const auto& word : words) names.push_back(word.first);
  table
      .add(
          name,
          [&value, &words](const std::vector<std::string>& texts) {
            value = words.at(texts.back());
          },
          "WORD", help + ": " + alternatives(names))
      .among(names);
}

/// The row's option as the target takes it; null if it does not.
const convert::TakenOption* takenBy(const convert::ExportTarget& target, const OptionRow& row) {
  const auto found =
      std::find_if(target.options.begin(), target.options.end(),
                   [&row](const convert::TakenOption& taken) { return row.name == taken.name; });
  return found == target.options.end() ? nullptr : &*found;
}

/// The reason why the target does nothing with an option that others take; empty if it counts.
std::string unusedReason(const OptionTable& table, const OptionRow& row,
                         const convert::ExportTarget& target) {
  if (const convert::TakenOption* const taken = takenBy(target, row))
    return missingNeed(table, taken->needs);
  std::string takers;
  for (const convert::ExportTarget& other : convert::exportTargets())
    if (takenBy(other, row) != nullptr)
      takers += (takers.empty() ? "" : ", ") + std::string(other.name);
  return takers.empty() ? "" : "is for " + takers + ", not for " + std::string(target.name);
}

}  // namespace

void addExportRows(OptionTable& table, convert::ExportOptions& options) {
  options.word = optionWord();
  table.group("");
  addOptionalChoice(table, "unit", options.unit, kUnits,
                    "Length unit, where the target leaves a choice [its first of --list]");
  addOptionalChoice(table, "up", options.axes, kUp,
                    "Axis that looks up (superior), where the target leaves a choice");
  table.group("Surface");
  addSurfaceRows(table, options.surface);
  table
      .add("max-pieces", &options.maxPieces, "N",
           "Greatest number of pieces of the wall, which is simplified until it has no more; 0: "
           "20000 for cathsim, as many as 64 cells a side need for mujoco")
      .in(WholeRange{0, 1'000'000});
  addGridRows(table, options);
  addSofaRows(table, options);
  addFlowRows(table, options);
  table.group("");
}

convert::OptionTexts exportOptionTexts(const OptionTable& table,
                                       const convert::ExportTarget& target) {
  convert::OptionTexts texts;
  for (const OptionRow& row : table.rows())
    if (takenBy(target, row) != nullptr)
      if (std::string text = row.valueText(); !text.empty()) texts[row.shownName()] = text;
  return texts;
}

void requireTargetOptions(const OptionTable& table, const convert::ExportTarget& target,
                          Progress& progress) {
  for (const OptionRow& row : table.rows()) {
    if (!row.isGiven || row.isArgument) continue;
    const std::string reason = unusedReason(table, row, target);
    if (!reason.empty()) refuseUnused(row, reason, progress);
  }
  requireInScope(table, {}, progress);
}

std::vector<std::string> exportTargetNames() {
  std::vector<std::string> names;
  for (const convert::ExportTarget& target : convert::exportTargets())
    names.emplace_back(target.name);
  return names;
}

const convert::ExportTarget& exportTarget(const std::string& name) {
  for (const convert::ExportTarget& target : convert::exportTargets())
    if (target.name == name) return target;
  const std::vector<std::string> names = exportTargetNames();
  throw unsupported(formats::printable(name) + ": lumen does not export to this; it exports to " +
                    alternatives(names) + didYouMean(name, names));
}

}  // namespace lumen::engine
