// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/export_sofa.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/export/shared/distance_grid.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/sofa/scene.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/vertex_streams.h"
#include "converters/io/mesh/write_plain.h"
#include "converters/io/volume/write_volume.h"
#include "formats/case/case_encoding.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

double insertedRadius(InstrumentKind kind) {
  double greatest = 0;
  for (const Instrument& one : makeInstruments(kind, 100, 1))
    greatest = std::max(greatest, one.radius());
  return greatest;
}

SceneInput makeSceneInput(const ExportInput& asked, const SofaOptions& options) {
  // a coil has its own length; others are pushed to the end of the path, and end behind it
  constexpr double kBehind = 20, kShortestInstrument = 80, kCurlShare = 1.6;
  const formats::CenterlineTree& tree = asked.source.tree;
  SceneInput input;
  input.insertion =
      findInsertion(tree, asked.options.insert, clearanceFor(insertedRadius(options.instrument)),
                    asked.options.word);
  input.branch = tree.branches[input.insertion.branch].label;
  input.instruments = makeInstruments(
      options.instrument, std::max(kShortestInstrument, input.insertion.pathLength + kBehind),
      kCurlShare * input.insertion.radius);
  if (options.instrument == InstrumentKind::Coil)
    input.insertion.pathLength = input.instruments.front().length();
  input.moves = asked.source.motion && options.wall == WallKind::Implicit;
  if (input.moves)
    input.stepsPerPush = stepsPerPush(tree, *asked.source.motion, input.insertion.path);
  if (options.wall == WallKind::Soft) input.frames = framesAlong(tree, input.insertion.path);
  // a grid is touched at the ends of beams only, and edges of the wall pass between those; a coil,
  // whose beams are short and soft, is pressed through with shorter ones (tests/sofa/results.md)
  constexpr double kBeamsOnGrid = 2;
  if (options.wall == WallKind::Grid && options.instrument != InstrumentKind::Coil)
    for (Instrument& instrument : input.instruments)
      for (RodSection& section : instrument.sections) section.beamLength /= kBeamsOnGrid;
  return input;
}

std::string pluginsOf(WallKind wall) {
  if (isOfCase(wall))
    return ", and LumenSofa, which the folder converters/export/sofa_plugin of lumen's source "
           "builds (README.md there)";
  return wall == WallKind::Grid ? ", SofaDistanceGrid and SofaImplicitField" : "";
}

std::string startText(const SceneInput& input, const SofaOptions& options) {
  std::string about;
  for (const std::string& line : aboutScene(input, options)) about += markdownText(line) + "\n";
  return exportText("sofa/README.md",
                    {{"about", about},
                     {"plugin", isOfCase(options.wall) ? " -l libLumenSofa.so" : ""},
                     {"steps", std::to_string(stepCount(input, options))},
                     {"plugins", pluginsOf(options.wall)},
                     {"release", options.dialect == SofaDialect::V23_06 ? "v23.06" : "v25.06"}});
}

/// The distances as doubles, positive in the lumen, little-endian.
std::string wallBytes(const DistanceGrid& grid) {
  std::vector<double> distances;
  for (const WallDistance& value : grid.values)
    distances.push_back(-static_cast<double>(value.distance));
  return {reinterpret_cast<const char*>(distances.data()), distances.size() * sizeof(double)};
}

void addGridFiles(ExportResult& result, SceneInput& scene, const ExportInput& input) {
  const double spacing =
      gridSpacing(input.options.spacing, scene.box, kGridBorder, input.source.tree);
  const Lattice lattice = latticeOver(scene.box, kGridBorder + kGridBorderSamples * spacing,
                                      spacing, input.options.word);
  const VesselDistance vessels(input.source);
  const DistanceGrid grid = sampleGrid({vessels}, lattice, input.progress);
  scene.grid = {lattice.size, lattice.first, lattice.last()};
  result.losses = gridLosses(lattice, input.source.tree);
  result.files.push_back({"wall.raw", wallBytes(grid),
                          "distances to the wall, mm, positive in the lumen, doubles, x fastest",
                          ""});
  const Volume distances = distanceVolume(grid, -1);
  result.files.push_back({"distance.mhd", metaImageHeader(distances, "distance.raw"),
                          "the same in floats, in `distance.raw`, for a DiscreteGridField", ""});
  result.files.push_back({"distance.raw", std::string(voxelBytes(distances)), "", ""});
}

void addSceneFiles(ExportResult& result, const SceneInput& input, const SofaOptions& options) {
  const SceneItem scene = makeScene(input, options);
  const auto about = aboutScene(input, options);
  result.files.push_back(
      {"scene.scn", printXml(scene, about), "the scene; data with units state them", ""});
  result.files.push_back({"scene.py", printPython(scene, about), "the same for SofaPython3", ""});
  result.others.push_back(
      {"positions.txt", "written by a run: points along the instruments, each tenth step"});
}

/// The surface of each system of vessels, which scenes show in its colour.
void addSystems(ExportResult& result, SceneInput& scene, const SurfaceMesh& surface) {
  for (const SystemPart& part : splitBySystem(surface)) {
    std::string word = part.name();
    std::replace(word.begin(), word.end(), '-', '_');
    const std::string file = "vessel-" + part.name() + ".obj";
    scene.systems.push_back({word, file, systemColor(part.system)});
    result.files.push_back({file, encodeObj(part.surface),
                            "the part of the surface that is of the system " + part.name(), ""});
  }
}

std::string insertedText(const SceneInput& input, const SofaOptions& options) {
  return "inserted in " + formats::printable(input.branch) + " at " +
         placeText(input.insertion.position, 2) + " mm, " +
         std::to_string(stepCount(input, options)) + " steps";
}

}  // namespace

ExportResult exportSofa(const ExportInput& input, const SofaOptions& options) {
  ExportResult result;
  SceneInput scene = makeSceneInput(input, options);
  ExportedSurface made = lumenSurface(input);
  scene.box = boundingBox(made.mesh);
  const std::vector<std::byte> bytes = formats::encodeBinary(input.source);
  if (options.wall == WallKind::Grid) addGridFiles(result, scene, input);
  addSystems(result, scene, made.mesh);
  addSceneFiles(result, scene, options);
  result.files.push_back({"vessel.obj", encodeObj(made.mesh),
                          "the surface of the vessels, closed, normals outwards", ""});
  result.files.push_back({"case.lumen",
                          {reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                          "the case: its tree, radii, names and models",
                          ""});
  result.start = startText(scene, options);
  result.playsMotion = scene.moves;
  result.remarks.push_back(insertedText(scene, options));
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

TargetRow sofaRow() {
  return {.name = "sofa",
          .title = "SOFA with BeamAdapter",
          .files = {"scene.scn", "scene.py", "vessel.obj", "case.lumen"},
          .units = {LengthUnit::Millimetre},
          .axes = {Axes::Lps},
          .holds = "the case; the surface; an instrument at the root, with friction contact",
          .lacks = "nothing: the case lies beside the scene",
          .options = {"edge",
                      "max-error",
                      "triangles",
                      "instrument",
                      "wall",
                      "dialect",
                      "step",
                      "insert",
                      {"grid", "wall", "grid"}}};
}

}  // namespace lumen::convert
