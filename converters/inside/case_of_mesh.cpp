// SPDX-License-Identifier: Apache-2.0
#include "converters/inside/case_of_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "converters/common/error.h"
#include "converters/inside/closed_mesh.h"
#include "converters/inside/inside_voxels.h"
#include "converters/inside/nodes_on_lines.h"
#include "converters/inside/vessel_lines.h"

namespace lumen::convert {
namespace {

/// "The surface has 3 loops; 2 of them became links". Empty if there are as many.
std::string loopsNote(const ClosedMesh& surface, const formats::CenterlineTree& tree) {
  std::size_t roots = 0;
  for (const formats::Branch& branch : tree.branches) roots += branch.parentNode < 0 ? 1 : 0;
  const std::int64_t handles =
      static_cast<std::int64_t>(roots) - eulerCharacteristic(surface.mesh) / 2;
  const auto links = static_cast<std::int64_t>(tree.links.size());
  if (handles <= 0 || handles == links) return {};
  return "the surface has " + std::to_string(handles) + (handles == 1 ? " loop; " : " loops; ") +
         std::to_string(links) + " of the tree are closed by a link";
}

}  // namespace

MeshCase caseOfMesh(TriangleMesh mesh, const std::string& name,
                    const std::optional<GivenCenterline>& centerline,
                    const std::map<std::string, formats::ParameterValue>& parameters,
                    Progress& progress) {
  const ClosedMesh surface = closeMesh(std::move(mesh));
  if (std::all_of(surface.end.begin(), surface.end.end(),
                  [](std::uint32_t end) { return end != ClosedMesh::kWall; }))
    throw invalidInput(name + ": this surface has no wall of a vessel, only flat ends");
  const LumenGeometry lumen(surface);
  const double width = leastWidth(surface, lumen.tree());
  if (!(width > 0))
    throw invalidInput(name + ": no ray from this surface's wall meets the wall on the other side; "
                              "it encloses no vessel");
  const VolumeGeometry grid = insideGrid(surface, width);
  progress.begin("tree", 0);
  VesselLines lines = centerline ? linesOf(centerline->file, centerline->name, lumen)
                                 : findLines(lumen, grid, progress);
  progress.end();
  if (lines.lines.empty())
    throw invalidInput(name + ": no vessel was found inside of this surface");
  MeshCase out;
  out.notes = std::move(lines.notes);
  out.result = nodesOnLines(lines.lines, lumen, progress);
  if (const std::string note = loopsNote(surface, out.result.tree); !note.empty())
    out.notes.push_back(name + ": " + note);
  out.result.metadata.voxelSize = grid.voxelSize();
  formats::Step step{"surface", "lumen " LUMEN_VERSION, parameters};
  step.parameters["cell"] = grid.voxelSize();
  step.parameters["centerline"] = centerline.has_value();
  out.result.metadata.steps.push_back(std::move(step));
  return out;
}

}  // namespace lumen::convert
