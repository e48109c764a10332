// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/surface.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/targets.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/write_plain.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {

namespace {

/// A tuple of Python.
std::string tuple(const Eigen::Vector3d& v) {
  return vectorText(v, kFloatDigits);
}

std::string moduleText(const std::vector<BranchPath>& paths,
                       const std::vector<formats::VesselSystem>& systems) {
  std::string branches, names;
  for (const BranchPath& path : paths) {
    if (!systems.empty())
      names += "    \"" + path.name + "\": \"" + systemName(systems[path.branch]) + "\",\n";
    branches += "    (\"" + path.name + "\", [\n";
    for (std::size_t k = 0; k < path.points.size(); ++k) {
      const Eigen::Vector3d& p = path.points[k];
      branches += "        (" + numberText(p.x()) + ", " + numberText(p.y()) + ", " +
                  numberText(p.z()) + ", " + numberText(path.radii[k]) + "),\n";
    }
    branches += "    ]),\n";
  }
  return exportText("steve/vessels.py", {{"position", tuple(paths.front().points.front())},
                                         {"direction", tuple(paths.front().tangent(0))},
                                         {"branches", branches},
                                         {"systems", names}});
}

}  // namespace

ExportResult exportSteve(const ExportInput& input) {
  const std::vector<BranchPath> paths = branchPaths(input.source.tree);
  ExportedSurface made = lumenSurface(input);
  const ExportFrame centimetres{LengthUnit::Centimetre, Axes::Lps};
  ExportResult result;
  result.start = exportText("steve/README.md");
  result.files = {{"vessels.py", moduleText(paths, formats::knownBranchSystems(input.source)),
                   "branches with their radii, insertion, mesh as a vessel tree", ""},
                  {"vessel.obj", encodeObj(turnedOver(made.mesh)),
                   "the closed surface of the vessels, its normals into the lumen", ""},
                  {"Meshes/vessel.vtp", encodeVtpIn(centimetres.of(made.mesh), "cm"),
                   "the same surface in cm, its normals out of the lumen", "cm"}};
  for (std::size_t k = 0; k < paths.size(); ++k)
    result.files.push_back(
        {"Paths/" + paths[k].name + ".pth", encodePth(paths[k], k + 1), "", "cm"});
  result.others.push_back({"Paths/*.pth", "paths as of SimVascular, in cm"});
  result.losses = treeLosses(input.source.tree, "a set of paths");
  result.ends = std::move(made.ends);
  result.surface = std::move(made.report);
  return result;
}

TargetRow steveRow() {
  return {.name = "steve",
          .title = "stEVE",
          .files = {"vessels.py", "vessel.obj", "Meshes/vessel.vtp"},
          .units = {LengthUnit::Millimetre},
          .axes = {Axes::Lps},
          .holds = "the branches with their radii; the surface; the root as the insertion",
          .lacks = "links that close loops, and that an aneurysm is one",
          .options = {"edge", "max-error"}};
}

}  // namespace lumen::convert
