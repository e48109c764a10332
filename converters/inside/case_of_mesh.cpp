// SPDX-License-Identifier: Apache-2.0
#include "converters/inside/case_of_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

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

// Of the area: so much of a tube's wall faces the tube itself across its lumen, if it has a thickness.
constexpr double kFacing = 0.4;
constexpr std::size_t kMostFacing = 4000;  // rays

/// Whether the surface is that of a wall with a thickness: joined at its ends, inner and outer side make a
/// ring, and the inner side faces itself from outside of what the surface encloses.
bool isThickWall(const ClosedMesh& surface, const TriangleTree& tree) {
  if (eulerCharacteristic(surface.mesh) > 0) return false;
  const auto& position = surface.mesh.position;
  const std::size_t stride = std::max<std::size_t>(1, surface.mesh.triangle.size() / kMostFacing);
  double all = 0, facing = 0;
  for (std::size_t t = 0; t < surface.mesh.triangle.size(); t += stride) {
    const Triangle& corners = surface.mesh.triangle[t];
    const Eigen::Vector3d a = position[corners[0]], b = position[corners[1]],
                          c = position[corners[2]];
    const double area = (b - a).cross(c - a).norm();
    const auto hit = tree.firstHit((a + b + c) / 3, tree.normal(static_cast<std::uint32_t>(t)),
                                   1e-6 * std::sqrt(area));
    all += area;
    if (hit && !hit->leaves) facing += area;
  }
  return facing > kFacing * all;
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
  if (isThickWall(surface, lumen.tree()))
    throw invalidInput(name +
                       ": this is the surface of a wall that has a thickness, inner and outer side "
                       "in one; expected the surface of the lumen, which is its inner side alone");
  const double width = leastWidth(surface, lumen.tree());
  if (!(width > 0))
    throw invalidInput(name +
                       ": no ray from this surface's wall meets the wall on the other side; "
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
