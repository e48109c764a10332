// SPDX-License-Identifier: Apache-2.0
#include "converters/app/export_options.h"

#include <map>
#include <string>
#include <vector>

#include "converters/app/suggestion.h"
#include "converters/app/value_checks.h"
#include "converters/surface/length.h"

namespace lumen::app {

namespace {

using convert::InstrumentKind;
using convert::SofaDialect;
using convert::WallKind;

const char* const kSofa = "SOFA";
const char* const kSurface = "Surface";

const std::map<std::string, InstrumentKind> kInstruments = {
    {"guidewire", InstrumentKind::Guidewire},
    {"catheter", InstrumentKind::Catheter},
    {"coil", InstrumentKind::Coil}};
const std::map<std::string, WallKind> kWalls = {
    {"mesh", WallKind::Mesh}, {"implicit", WallKind::Implicit}, {"grid", WallKind::Grid}};
const std::map<std::string, SofaDialect> kDialects = {{"current", SofaDialect::Current},
                                                      {"v23.06", SofaDialect::V23_06}};

/// One of the words of `named`.
template <class T>
void addWord(CLI::App& app, const std::string& name, T& value,
             const std::map<std::string, T>& named, const std::string& initial,
             const std::string& help) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : named) words.push_back(word);
  app.add_option_function<std::string>(
         name, [&value, &named](const std::string& found) { value = named.at(found); },
         help + ": " + alternatives(words))
      ->type_name("WORD")
      ->group(kSofa)
      ->default_str(initial)
      ->check(oneOf(words));
}

}  // namespace

void addExportOptions(CLI::App& app, ExportOptions& options) {
  addWord(app, "--instrument", options.sofa.instrument, kInstruments, "guidewire",
          "What is inserted, a guidewire within a catheter");
  addWord(app, "--wall", options.sofa.wall, kWalls, "mesh",
          "What it touches, triangles, the models by the plugin LumenSofa, or distances on a grid");
  addWord(app, "--dialect", options.sofa.dialect, kDialects, "current", "Version of SOFA");
  app.add_option("--step", options.sofa.step, "How far it advances in a time step of 0.01 s")
      ->type_name("MM")
      ->group(kSofa)
      ->capture_default_str()
      ->check(numberIn({0.001, 1}));
  app.add_option("--insert", options.sofa.insert,
                 "Branch at whose beginning it is inserted [the root]")
      ->type_name("LABEL")
      ->group(kSofa);

  app.add_option("--grid", options.sofa.grid,
                 "Distance between the samples of --wall grid; 0: by the size of the vessels")
      ->type_name("MM")
      ->group(kSofa)
      ->capture_default_str()
      ->check(numberIn({0, 1e3}));

  // a wall of triangles is asked many times a step: half of the radius is what its curvature needs
  options.surface.edge.share = 0.5;
  convert::EdgeLength& edge = options.surface.edge;
  app.add_option_function<std::string>(
         "--edge",
         [&edge](const std::string& text) {
           const convert::Length length = convert::parseLength(text, "--edge");
           edge.share = length.radii;
           if (length.mm > 0) edge.minimum = edge.maximum = length.mm;
         },
         "Length of edges, as a share of the vessel's radius such as 0.25r, or in mm")
      ->type_name("LENGTH")
      ->group(kSurface)
      ->default_str("0.5r");
  app.add_option(
         "--max-error", options.surface.maxError,
         "Drop triangles as long as the surface stays within this distance of that with all; "
         "0: none")
      ->type_name("MM")
      ->group(kSurface)
      ->capture_default_str()
      ->check(numberIn({0, 1e6}));
}

}  // namespace lumen::app
