// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/openfoam.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/export/shared/cells.h"
#include "converters/export/shared/flow_inlets.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/openfoam/foam_patches.h"
#include "converters/export/targets/openfoam/poly_mesh.h"
#include "converters/io/mesh/write_plain.h"

namespace lumen::convert {

namespace {

std::string cellsRemark(const FoamCells& cells) {
  return "about " + shownFigure(cells.count) + " cells, " + std::to_string(cells.across) +
         " or more across each vessel, and " + std::to_string(cells.layers) + " layers at the wall";
}

/// The sentences on the links and the ends that the mesh cannot resolve.
void reportTrimmed(const Unresolved& gone, FoamGrain grain, const FieldWord& word,
                   ExportResult& result) {
  constexpr std::size_t kMostShown = 10;
  for (const auto& [one, other] : gone.links)
    result.losses.push_back(one + " and " + other + ": no blood flows through the link between " +
                            "them, as " + shownFigure(mostCells(grain)) +
                            " cells cannot resolve it");
  if (gone.radius > 0)
    result.remarks.push_back("ends thinner than " + fixedText(gone.radius, 3) +
                             " mm are left out, so that there are no more than " +
                             shownFigure(mostCells(grain)) + " cells");
  const std::vector<TrimmedEnd>& ends = gone.ends;
  for (std::size_t k = 0; k < ends.size() && k < kMostShown; ++k)
    result.losses.push_back(trimmedText(ends[k]) + ": left out, as " +
                            shownFigure(mostCells(grain)) + " cells cannot resolve it");
  if (ends.size() > kMostShown)
    result.losses.push_back(counted(ends.size() - kMostShown, "more end", "more ends") +
                            " left out for the same reason; " + word("cells") +
                            " allows more cells");
}

std::string startText(FoamFlow flow) {
  return exportText(
      "openfoam/README.md",
      {{"velocity", numberText(100 * blood::kMeanVelocity)},
       {"flow", flow == FoamFlow::Steady
                    ? "steady and laminar, in `simpleFoam`"
                    : "over two cycles of the heart, laminar, in `pimpleFoam`. Flows follow the "
                      "waveform of the common carotid artery of Boileau et al., Int J Numer Meth "
                      "Biomed Eng 31, 2015, scaled to each end's mean"}});
}

/// A report on the surface of a part of a case, with the branches as the whole case counts them.
SurfaceReport asInCase(SurfaceReport report, const formats::CenterlineTree& part,
                       const formats::CenterlineTree& whole) {
  const auto indexOf = [&](std::uint32_t branch) {
    std::uint32_t at = 0;
    while (whole.branches[at].label != part.branches[branch].label) ++at;
    return at;
  };
  for (Overlap& overlap : report.overlaps) {
    overlap.branch = indexOf(overlap.branch);
    overlap.other = indexOf(overlap.other);
  }
  return report;
}

}  // namespace

namespace {

/// The surface with the cells that snappyHexMesh is going to make of it.
ExportedSurface cutByOpenFoam(const ExportInput& input, FoamGrain grain, FoamCase& foam,
                              ExportResult& result) {
  const FoamCells cells = foamCells(input.source.tree, grain);
  ExportedSurface made = lumenSurface(input);
  const std::vector<int> levels = divideWall(made.mesh, cells, input.frame.scale());
  foam.patches = foamPatches(made.mesh, levels, made.ends);
  foam.block = foamBlock(boundingBox(made.mesh), input.frame.length(cells.edge));
  foam.layers = cells.layers;
  foam.inside = deepestPoints(input.source.tree, made.mesh, input.frame, input.progress);
  result.remarks.push_back(cellsRemark(cells));
  return made;
}

/// The surface with the cells within it, which are written.
ExportedSurface cutByLumen(const ExportInput& input, FoamCase& foam, VolumeMesh& cells,
                           ExportResult& result) {
  ExportedSurface made = lumenSurface({input.source, input.options, {}, input.progress});
  MadeVolumeMesh within = cellsWithin(input, made.mesh, made.report.gap);
  made.mesh = input.frame.of(std::move(made.mesh));
  foam.isMeshed = true;
  foam.patches = foamPatches(made.mesh, std::vector<int>(made.mesh.groups.size(), 0), made.ends);
  cells = std::move(within.mesh);
  result.remarks.push_back(cellsSentence(within.report));
  return made;
}

}  // namespace

ExportResult exportOpenFoam(const ExportInput& input, const FoamOptions& options) {
  const std::vector<StatedInlet> inlets = statedInlets(input.options.inlets, input.options.word);
  FlowCase flowing = flowCase(input.source, inlets, input.options.word, input.options.keepEnds);
  ExportResult result;
  result.losses = std::move(flowing.losses);
  const bool isFilled = options.cells == FoamGrain::Prisms;
  if (!isFilled)
    reportTrimmed(trimToCells(flowing.value, options.cells), options.cells, input.options.word,
                  result);
  const formats::Case& source = flowing.value;
  const ExportInput cut{source, input.options, input.frame, input.progress};
  FoamCase foam;
  foam.flow = options.flow;
  VolumeMesh cells;
  ExportedSurface made = isFilled ? cutByLumen(cut, foam, cells, result)
                                  : cutByOpenFoam(cut, options.cells, foam, result);
  const FlowNetwork network = flowNetwork(source.tree, inlets);
  for (std::string& loss : assignFlows(foam.patches, network))
    result.losses.push_back(std::move(loss));
  result.outlets = outletRows(foam.patches, network);
  result.warnings = outletWarnings(network, result.outlets);
  result.start = startText(options.flow);
  result.files = foamDictionaries(foam);
  if (isFilled)
    for (ExportFile& file : polyMesh(cells, foam.patches)) result.files.push_back(std::move(file));
  result.files.push_back({"constant/triSurface/vessel.stl", encodeStl(made.mesh, true),
                          "the closed surface: solids `wall*`, `inlet*`, `outlet*`", ""});
  result.files.push_back({"expected.csv", expectedTable(foam.patches),
                          "flow through each end, and its pressure by Poiseuille", ""});
  for (const FaceGroup& group : made.mesh.groups)
    if (group.kind == FaceKind::Cap)
      result.losses.push_back(
          group.name + ": this end is not flat, so it is a wall, and nothing flows through it");
  result.ends = std::move(made.ends);
  result.surface = asInCase(std::move(made.report), source.tree, input.source.tree);
  return result;
}

TargetRow openFoamRow() {
  return {.name = "openfoam",
          .title = "OpenFOAM",
          .files = {"Allrun", "system/controlDict", "constant/triSurface/vessel.stl", "0/U", "0/p",
                    "expected.csv"},
          .units = {LengthUnit::Metre},
          .axes = {Axes::Lps},
          .holds =
              "the surface with its named ends; prisms at the wall and tetrahedra within, if they "
              "are asked "
              "for; a steady flow, or one of two heartbeats",
          .lacks =
              "branches, radii, and that an aneurysm is one; ends that its cells cannot "
              "resolve, and parts without a path from an inlet",
          .options = {"edge",
                      "max-error",
                      "triangles",
                      "extend",
                      "inlets",
                      "keep-ends",
                      "cells",
                      "flow",
                      {"layers", "cells", "prisms"},
                      {"growth", "cells", "prisms"},
                      {"layer-height", "cells", "prisms"}}};
}

}  // namespace lumen::convert
