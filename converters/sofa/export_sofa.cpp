// SPDX-License-Identifier: Apache-2.0
#include "converters/sofa/export_sofa.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "converters/mesh/write_plain.h"
#include "converters/sofa/distance_grid.h"
#include "formats/case/binary_encode.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

double insertedRadius(InstrumentKind kind) {
  double greatest = 0;
  for (const Instrument& one : instrumentsOf(kind, 100, 1))
    greatest = std::max(greatest, one.radius());
  return greatest;
}

SceneInput inputOf(const formats::Case& source, const SofaOptions& options) {
  // a coil is as long as it is; others are pushed to the end of the way, and end behind it
  constexpr double kBehind = 20, kLeast = 80, kCurlShare = 1.6;
  SceneInput input;
  input.insertion =
      insertionOf(source.tree, options.insert, clearanceFor(insertedRadius(options.instrument)));
  input.branch = source.tree.branches[input.insertion.branch].label;
  input.instruments =
      instrumentsOf(options.instrument, std::max(kLeast, input.insertion.way + kBehind),
                    kCurlShare * input.insertion.radius);
  if (options.instrument == InstrumentKind::Coil)
    input.insertion.way = input.instruments.front().length();
  // a grid is touched at the ends of beams only, and edges of the wall pass between those; a coil, whose beams are
  // short and soft, is pressed through with shorter ones (tests/sofa/results.md)
  constexpr double kBeamsOnGrid = 2;
  if (options.wall == WallKind::Grid && options.instrument != InstrumentKind::Coil)
    for (Instrument& instrument : input.instruments)
      for (RodSection& section : instrument.sections) section.beamLength /= kBeamsOnGrid;
  return input;
}

void setBox(SceneInput& input, const SurfaceMesh& mesh) {
  for (std::size_t a = 0; a < 3; ++a) {
    input.low[a] = std::numeric_limits<double>::infinity();
    input.high[a] = -input.low[a];
    for (const Float3& p : mesh.position) {
      input.low[a] = std::min<double>(input.low[a], p[a]);
      input.high[a] = std::max<double>(input.high[a], p[a]);
    }
  }
}

std::string readmeOf(const SceneInput& input, const SofaOptions& options) {
  const bool isImplicit = options.wall == WallKind::Implicit;
  const std::string steps = std::to_string(stepsOf(input, options));
  std::string text = "# A scene of SOFA\n\n";
  for (const std::string& line : aboutScene(input, options)) text += line + "\n";
  text += "\nStart it without a window, where the files are:\n\n    runSofa";
  text += isImplicit ? " -l libLumenSofa.so" : "";
  text += " -g batch -n " + steps + " scene.scn\n\n";
  text +=
      "or with one by `runSofa scene.scn`, or `runSofa -l SofaPython3 scene.py`, which is the same "
      "scene for\nSofaPython3. It needs the plugin BeamAdapter";
  text += isImplicit ? ", and LumenSofa, which is built from converters/sofa/plugin of lumen" : "";
  text += options.wall == WallKind::Grid ? ", SofaDistanceGrid and SofaImplicitField" : "";
  text += ".\n\n";
  text += options.dialect == SofaDialect::V23_06 ? "Written for SOFA v23.06.\n\n"
                                                 : "Written for SOFA v25.06.\n\n";
  text +=
      "| file | |\n|---|---|\n"
      "| `scene.scn`, `scene.py` | the scene; data that have units say them |\n"
      "| `vessel.obj` | the surface of the vessels, closed, normals outwards, mm, LPS |\n"
      "| `case.lumen` | the case: its tree, radii, names and models |\n"
      "%GRID%| `positions.txt` | written by a run: points along the instruments, each tenth step "
      "|\n";
  const std::string place = "%GRID%";
  const std::string grid =
      options.wall == WallKind::Grid
          ? "| `wall.raw` | distances to the wall, mm, positive in the lumen, doubles, x fastest "
            "|\n"
            "| `distance.mhd`, `distance.raw` | the same in floats, for a DiscreteGridField |\n"
          : "";
  return text.replace(text.find(place), place.size(), grid);
}

void addGridFiles(SofaExport& result, SceneInput& input, const formats::Case& source,
                  std::span<const std::byte> bytes, const SofaOptions& options,
                  Progress& progress) {
  const auto& radius = source.tree.radius;
  const double thinnest = *std::min_element(radius.begin(), radius.end());
  const DistanceGrid grid =
      distanceGrid(bytes, input.low, input.high, options.grid, thinnest, progress);
  input.grid = {grid.size, grid.first, grid.last()};
  result.gridSpacing = grid.spacing;
  result.files.push_back({"wall.raw", encodeGridDoubles(grid)});
  result.files.push_back({"distance.mhd", gridHeader(grid, "distance.raw")});
  result.files.push_back({"distance.raw", encodeGridFloats(grid)});
}

}  // namespace

SofaExport exportSofa(const formats::Case& source, const SofaOptions& options,
                      const ClosedSurfaceOptions& surface, Progress& progress) {
  SofaExport result;
  SceneInput input = inputOf(source, options);
  ClosedSurface made = closedSurface(source, surface, progress);
  setBox(input, made.levels.front());
  const std::vector<std::byte> bytes = formats::encodeBinary(source);
  if (options.wall == WallKind::Grid) addGridFiles(result, input, source, bytes, options, progress);
  const SceneItem scene = makeScene(input, options);
  const auto about = aboutScene(input, options);
  std::vector<NamedFile> files = {
      {"scene.scn", printXml(scene, about)},
      {"scene.py", printPython(scene, about)},
      {"vessel.obj", encodeObj(made.levels.front())},
      {"case.lumen", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}},
      {"README.md", readmeOf(input, options)}};
  result.files.insert(result.files.begin(), files.begin(), files.end());
  result.insertion = input.insertion;
  result.steps = stepsOf(input, options);
  result.surface = std::move(made.report);
  return result;
}

}  // namespace lumen::convert
