// SPDX-License-Identifier: Apache-2.0
#include "converters/app/export_options.h"

#include <map>
#include <string>

#include "converters/app/option_group.h"
#include "converters/app/value_checks.h"
#include "converters/surface/length.h"

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

void addSofaOptions(CLI::App& app, convert::SofaOptions& sofa) {
  OptionGroup group(app, "SOFA");
  group.addChoice("--instrument", sofa.instrument, kInstruments,
                  "What is inserted, a guidewire within a catheter");
  group.addChoice(
      "--wall", sofa.wall, kWalls,
      "What it touches, triangles, the models by the plugin LumenSofa, or distances on a grid");
  group.addChoice("--dialect", sofa.dialect, kDialects, "Version of SOFA");
  group.add("--step", sofa.step, "MM", "How far it advances in a time step of 0.01 s")
      ->check(numberIn({0.001, 1}));
  app.add_option("--insert", sofa.insert, "Branch at whose beginning it is inserted [the root]")
      ->type_name("LABEL")
      ->group("SOFA");
  group
      .add("--grid", sofa.grid, "MM",
           "Distance between the samples of --wall grid; 0: by the size of the vessels")
      ->check(kNotNegative);
}

}  // namespace

void addExportOptions(CLI::App& app, ExportOptions& options) {
  addSofaOptions(app, options.sofa);
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
      ->group("Surface")
      ->default_str("0.5r");
  OptionGroup(app, "Surface")
      .add("--max-error", options.surface.maxError, "MM",
           "Drop triangles as long as the surface stays within this distance of that with all; 0: "
           "none")
      ->check(kNotNegative);
}

}  // namespace lumen::app
