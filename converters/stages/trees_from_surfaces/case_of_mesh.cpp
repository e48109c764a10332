// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/case_of_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/geometry/mesh_edges.h"
#include "converters/geometry/triangle_tree.h"
#include "converters/stages/repair/repair.h"
#include "converters/stages/trees_from_surfaces/closed_mesh.h"
#include "converters/stages/trees_from_surfaces/vessel_line.h"

namespace lumen::convert {
namespace {

/// Half of the least width that the search resolves, in its voxels.
constexpr double kLeastRadius = 0.5;
/// Radii of an opening from it to the end of a centerline that leads to it.
constexpr double kNearOpening = 3;

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

/// A remark on each opening near which no line ends.
std::vector<std::string> missedOpenings(const std::vector<VesselLine>& lines,
                                        const std::vector<MeshEnd>& openings) {
  std::vector<std::string> notes;
  for (const MeshEnd& end : openings) {
    const auto isNear = [&](const Eigen::Vector3d& tip) {
      return (tip - end.centre).norm() < kNearOpening * end.radius;
    };
    const bool isReached = std::any_of(lines.begin(), lines.end(), [&](const VesselLine& line) {
      return (line.parent < 0 && isNear(line.point.front())) || isNear(line.point.back());
    });
    if (!isReached)
      notes.push_back("the opening at " + vectorText(end.centre) + " mm, of " +
                      shownFigure(end.radius) + " mm radius, is no end of the tree");
  }
  return notes;
}

/// A surface without openings and without nested parts, which is no wall with a thickness: such a
/// wall is replaced by its inner side. Reports in `notes` the parts that were left out.
ClosedMesh lumenSurface(TriangleMesh mesh, const std::string& name, std::vector<std::string>& notes,
                        const Progress& progress) {
  UnnestedMesh apart = unnested(std::move(mesh));
  if (apart.outer > 0)
    notes.push_back(name +
                    ": this is a wall with a thickness, its inner and outer side apart; the inner "
                    "side was taken for the lumen");
  if (apart.enclosed > 0)
    notes.push_back(name + ": " + std::to_string(apart.enclosed) +
                    (apart.enclosed == 1 ? " part that lies" : " parts that lie") +
                    " within another one was left out");
  ClosedMesh surface = closeMesh(std::move(apart.mesh));
  const auto inner = innerSide(surface, TriangleTree(surface.mesh), progress);
  if (!inner) return surface;
  const std::string wall = name + ": this is the surface of a wall that has a thickness";
  const std::size_t taken = inner->triangle.size(), all = surface.mesh.triangle.size();
  RepairResult repaired;
  try {
    repaired = repairMesh(*inner, name, progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::InvalidInput) throw;
    throw invalidInput(wall +
                       ", inner and outer side in one, and its inner side alone encloses no lumen; "
                       "expected the surface of the lumen");
  }
  notes.push_back(wall + "; its inner side, " + std::to_string(taken) + " of " +
                  std::to_string(all) + " triangles, was taken for the lumen");
  return closeMesh(std::move(repaired.mesh));
}

}  // namespace

MeshCase caseOfMesh(TriangleMesh mesh, const std::string& name,
                    const std::optional<GivenCenterline>& centerline,
                    const std::map<std::string, formats::ParameterValue>& parameters,
                    Progress& progress) {
  std::vector<std::string> notes;
  const ClosedMesh surface = lumenSurface(std::move(mesh), name, notes, progress);
  MeshCase out = caseOfLumen(surface, 0, name, centerline, parameters, progress);
  out.notes.insert(out.notes.begin(), notes.begin(), notes.end());
  return out;
}

MeshCase caseOfLumen(const ClosedMesh& surface, double resolution, const std::string& name,
                     const std::optional<GivenCenterline>& centerline,
                     const std::map<std::string, formats::ParameterValue>& parameters,
                     Progress& progress) {
  MeshCase out;
  if (std::all_of(surface.end.begin(), surface.end.end(),
                  [](std::uint32_t end) { return end != ClosedMesh::kWall; }))
    throw invalidInput(name + ": this surface has no wall of a vessel, only flat ends");
  const LumenGeometry lumen(surface);
  const double width = leastWidth(surface, lumen.tree());
  if (!(width > 0))
    throw invalidInput(name +
                       ": no ray from this surface's wall meets the wall on the other side; "
                       "it encloses no vessel");
  const VolumeGeometry grid = insideGrid(surface, std::max(width, resolution));
  progress.begin("tree", 0);
  // labels are open where they touch a face of their volume, with a vessel or without
  const bool isMesh = resolution == 0;
  const VesselLines lines = centerline ? clipLines(centerline->file, centerline->name, lumen)
                                       : findLines(lumen, grid, isMesh, progress);
  progress.end();
  if (lines.lines.empty())
    throw invalidInput(name + ": no vessel was found inside of this surface");
  out.notes.insert(out.notes.end(), lines.notes.begin(), lines.notes.end());
  std::copy_if(surface.ends.begin(), surface.ends.end(), std::back_inserter(out.openings),
               [](const MeshEnd& end) { return end.wasOpen; });
  if (isMesh)
    for (const std::string& note : missedOpenings(lines.lines, out.openings))
      out.notes.push_back(name + ": " + note);
  out.result = nodesOnLines(lines.lines, lumen, kLeastRadius * grid.voxelSize(), progress);
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
