// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/repair/repair.h"

#include <numeric>
#include <span>
#include <utility>

#include "converters/geometry/mesh_edges.h"
#include "converters/io/mesh/mesh_builder.h"
#include "converters/stages/repair/repair_steps.h"

namespace lumen::convert {
namespace {

/// Triangles of edges that still have more than two, or two with the same direction.
std::vector<bool> crowdedTriangles(const MeshInRepair& work, bool& any) {
  std::vector<bool> crowded(work.mesh.triangle.size(), false);
  any = false;
  forEachEdge(edgeUses(work.mesh.triangle), [&](std::span<const EdgeUse> edge) {
    const auto runsUp = [&](const EdgeUse& use) {
      return startOf(work.mesh.triangle, use.side) == use.low;
    };
    if (edge.size() == 1 || (edge.size() == 2 && runsUp(edge[0]) != runsUp(edge[1]))) return;
    any = true;
    for (const EdgeUse& use : edge) crowded[use.side / 3] = true;
  });
  return crowded;
}

/// Makes the triangles oriented sheets whose points have one fan each.
void makeManifold(MeshInRepair& work, const std::string& name, const Progress& progress) {
  std::size_t turned = 0, cut = 0, split = 0, dropped = 0;
  for (bool again = true; again;) {
    progress.check();
    turned += orientSheets(work, name);
    cut += cutEdges(work);
    split += splitPoints(work);
    // an edge that leads into the same sheet at both its points cannot be cut: its triangles are
    // dropped, and the hole is filled
    const std::vector<bool> crowded = crowdedTriangles(work, again);
    if (again) dropped += work.dropTriangles(crowded);
  }
  work.record("turned", turned, "triangle round", "triangles round");
  work.record("cut", cut, "edge of more than two triangles", "edges of more than two triangles");
  work.record("split", split, "point where sheets touch", "points where sheets touch");
  work.record("dropped", dropped, "triangle at an edge that could not be cut",
              "triangles at edges that could not be cut");
}

}  // namespace

RepairResult repairMesh(const TriangleMesh& mesh, const std::string& name,
                        const Progress& progress) {
  MeshInRepair work;
  work.mesh = mesh;
  work.source.resize(mesh.triangle.size());
  std::iota(work.source.begin(), work.source.end(), 0U);
  mergePoints(work);
  progress.check();
  dropDegenerate(work);
  dropDuplicates(work);
  if (work.mesh.triangle.empty())
    refuseMesh(name, "",
               "none of its " + std::to_string(mesh.triangle.size()) +
                   " triangles has an area; expected a surface");
  makeManifold(work, name, progress);
  progress.check();
  RepairResult result;
  result.components = settleParts(work, name);
  fillHoles(work);
  result.openings = findBoundaryLoops(work);
  result.mesh = std::move(work.mesh);
  result.source = std::move(work.source);
  result.repairs = std::move(work.repairs);
  return result;
}

}  // namespace lumen::convert
