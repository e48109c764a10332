// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/export_options.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/suggestion.h"
#include "converters/cli/option_group.h"
#include "converters/cli/value_checks.h"
#include "converters/stages/surface/length.h"
#include "formats/container/printable.h"

namespace lumen::app {

namespace {

using convert::InstrumentKind;
using convert::SofaDialect;
using convert::WallKind;

const std::map<std::string, InstrumentKind> kInstruments = {
    {"guidewire", InstrumentKind::Guidewire},
    {"catheter", InstrumentKind::Catheter},
    {"coil", InstrumentKind::Coil}};
const std::map<std::string, WallKind> kWalls = {
    {"mesh", WallKind::Mesh}, {"implicit", WallKind::Implicit}, {"grid", WallKind::Grid}};
const std::map<std::string, SofaDialect> kDialects = {{"current", SofaDialect::Current},
                                                      {"v23.06", SofaDialect::V23_06}};

const std::map<std::string, convert::GridFormat> kGridFormats = {
    {"nrrd", convert::GridFormat::Nrrd},
    {"nifti", convert::GridFormat::Nifti},
    {"mhd", convert::GridFormat::Mhd},
    {"vdb", convert::GridFormat::Vdb},
    {"cdf", convert::GridFormat::Cdf}};

const std::map<std::string, convert::LengthUnit> kUnits = {{"mm", convert::LengthUnit::Millimetre},
                                                           {"cm", convert::LengthUnit::Centimetre},
                                                           {"m", convert::LengthUnit::Metre}};
const std::map<std::string, convert::Axes> kUp = {{"z", convert::Axes::Lps},
                                                  {"y", convert::Axes::Lsa}};

void addSofaOptions(CLI::App& app, convert::ExportOptions& options) {
  convert::SofaOptions& sofa = options.sofa;
  OptionGroup group(app, "SOFA");
  group.addChoice("--instrument", sofa.instrument, kInstruments,
                  "What is inserted, a guidewire within a catheter");
  group.addChoice(
      "--wall", sofa.wall, kWalls,
      "What it touches, triangles, the models by the plugin LumenSofa, or distances on a grid");
  group.addChoice("--dialect", sofa.dialect, kDialects, "Version of SOFA");
  group.add("--step", sofa.step, "MM", "How far it advances in a time step of 0.01 s")
      ->check(numberIn({0.001, 1}));
  app.add_option("--insert", options.insert, "Branch at whose beginning it is inserted [the root]")
      ->type_name("LABEL")
      ->group("SOFA");
}

void addGridOptions(CLI::App& app, convert::ExportOptions& options) {
  convert::GridOptions& grid = options.grid;
  OptionGroup group(app, "Grid");
  group
      .add("--grid", options.spacing, "MM",
           "Distance between the samples of a grid; 0: by the size of the vessels")
      ->check(kNotNegative);
  app.add_option_function<std::vector<std::string>>(
         "--format",
         [&grid](const std::vector<std::string>& words) {
           grid.formats.clear();
           for (const std::string& word : words) grid.formats.push_back(kGridFormats.at(word));
         },
         "Of the files, one or more: " + alternatives(app::namesOf(kGridFormats)))
      ->type_name("WORD")
      ->group("Grid")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("nrrd")
      ->check(oneOf(app::namesOf(kGridFormats)));
  app.add_option("--band", grid.band,
                 "How far from the wall distances go on; beyond it they are clamped, or left out "
                 "[everywhere; vdb: 3 samples]")
      ->type_name("MM")
      ->group("Grid")
      ->check(kPositive);
  group.addFlag("--half", grid.half, "vdb: distances of 16 bits");
  group.addFlag("--per-branch", grid.perBranch,
                "A grid for each branch and its neighbourhood along the tree, instead of one, in "
                "which vessels that touch are merged");
  group.addFlag("--exact", grid.exact,
                "Distances to the nearest point of the wall in the lumen, too, with a kink at its "
                "axis, instead of libblob's, which are smooth, and right to first order");
}

template <class Value>
void addOptionalChoice(CLI::App& app, const std::string& name, std::optional<Value>& value,
                       const std::map<std::string, Value>& words, const std::string& help) {
  std::vector<std::string> names;
  for (const auto& word : words) names.push_back(word.first);
  app.add_option_function<std::string>(
         name, [&value, words](const std::string& text) { value = words.at(text); }, help)
      ->check(oneOf(names));
}

void addSurfaceOptions(CLI::App& app, convert::ClosedSurfaceOptions& surface) {
  convert::EdgeLength& edge = surface.edge;
  app.add_option_function<std::string>(
         "--edge",
         [&edge](const std::string& text) {
           const convert::Length length = convert::parseLength(text, "--edge");
           edge.share = length.radii;
           if (length.mm > 0) edge.minimum = edge.maximum = length.mm;
         },
         "Length of edges, as a share of the vessel's radius such as 0.25r, or in mm")
      ->type_name("LENGTH")
      ->group("Surface")
      ->default_str("0.5r");
  app.add_option_function<std::vector<std::string>>(
         "--extend",
         [&surface](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             surface.extend.push_back(convert::parseEndLength(text, "--extend"));
         },
         "Flow extensions at all ends, such as 5r or 20mm, or at those of a branch: LABEL=5r")
      ->option_text("[LABEL=]LENGTH")
      ->group("Surface");
  app.add_option_function<std::string>(
         "--thickness",
         [&surface](const std::string& text) {
           surface.thickness = convert::parseLength(text, "--thickness");
         },
         "Of a wall as a solid, such as 0.5 (mm) or 0.2r [by the target]")
      ->type_name("LENGTH")
      ->group("Surface");
  OptionGroup(app, "Surface")
      .add("--max-error", surface.maxError, "MM",
           "Drop triangles as long as the surface stays within this distance of that with all; 0: "
           "none")
      ->check(kNotNegative);
}

}  // namespace

void addExportOptions(CLI::App& app, convert::ExportOptions& options) {
  addOptionalChoice(app, "--unit", options.unit, kUnits,
                    "Of lengths, where the target leaves a choice [its first of --list]");
  addOptionalChoice(app, "--up", options.axes, kUp,
                    "The axis that looks up (superior), where the target leaves a choice");
  addSurfaceOptions(app, options.surface);
  addGridOptions(app, options);
  addSofaOptions(app, options);
}

convert::OptionTexts exportOptionTexts(const CLI::App& app, const convert::ExportTarget& target) {
  convert::OptionTexts texts;
  for (const std::string_view name : target.options) {
    const CLI::Option* const option = app.get_option(std::string(name));
    std::string text;
    for (const std::string& word : option->results()) text += (text.empty() ? "" : " ") + word;
    if (option->count() == 0) text = option->get_default_str();
    if (!text.empty()) texts[std::string(name)] = text;
  }
  return texts;
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

}  // namespace lumen::app
