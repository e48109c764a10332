// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/foam_patches.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "converters/base/error.h"
#include "converters/export/shared/blood.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/units.h"
#include "converters/io/mesh/plain_names.h"

namespace lumen::convert {

namespace {

/// Level of a triangle: that of the mean radius at its corners.
int levelOf(const SurfaceMesh& mesh, const Triangle& t, const FoamCells& cells, double scale) {
  double sum = 0;
  for (const std::uint32_t v : t) sum += static_cast<double>(mesh.radius[v]);
  return cells.level(sum / 3 / scale);
}

/// The ends of one connected part of the network.
struct FlowPart {
  std::vector<FoamPatch*> inlets, outlets;
  double flow = 0;  ///< m^3/s, of all inlets
};

FlowPart partOf(std::vector<FoamPatch>& patches, const FlowNetwork& network, const FlowTree& tree) {
  FlowPart part;
  for (FoamPatch& patch : patches) {
    const auto isAt = [&](std::uint32_t joint) { return network.joints[joint].name == patch.end; };
    if (patch.kind == FaceKind::Inlet)
      if (const auto at = std::find_if(tree.inlets.begin(), tree.inlets.end(), isAt);
          at != tree.inlets.end()) {
        patch.flow = network.joints[*at].inflow;
        part.flow += patch.flow;
        part.inlets.push_back(&patch);
      }
    if (patch.kind == FaceKind::Outlet &&
        std::any_of(tree.outlets.begin(), tree.outlets.end(), isAt))
      part.outlets.push_back(&patch);
  }
  return part;
}

/// Outlets share the flow of their part.
void share(FlowPart& part) {
  double shares = 0;
  for (const FoamPatch* outlet : part.outlets) shares += blood::murrayShare(outlet->radius);
  FoamPatch* widest = part.outlets.front();
  for (FoamPatch* outlet : part.outlets) {
    outlet->flow = part.flow * blood::murrayShare(outlet->radius) / shares;
    if (outlet->radius > widest->radius) widest = outlet;
  }
  widest->holdsPressure = true;
}

void setDrops(std::vector<FoamPatch>& patches, const FlowNetwork& network) {
  std::vector<double> into(network.joints.size(), 0.0);
  std::vector<std::uint32_t> zero;
  for (const FlowTree& tree : network.trees) zero.push_back(tree.outlets.front());
  const auto jointOf = [&](const FoamPatch& patch) {
    std::uint32_t joint = 0;
    while (joint < network.joints.size() && network.joints[joint].name != patch.end) ++joint;
    return joint;
  };
  for (const FoamPatch& patch : patches) {
    if (patch.flow == 0) continue;
    const std::uint32_t joint = jointOf(patch);
    into[joint] = patch.kind == FaceKind::Inlet ? patch.flow : -patch.flow;
    if (patch.holdsPressure) zero[network.joints[joint].tree] = joint;
  }
  const std::vector<double> pressures = pressuresOfFlows(network, into, zero);
  for (FoamPatch& patch : patches)
    if (patch.flow != 0 && !patch.holdsPressure) patch.drop = pressures[jointOf(patch)];
}

}  // namespace

std::vector<int> divideWall(SurfaceMesh& mesh, const FoamCells& cells, double scale) {
  std::map<int, std::uint32_t> groupOf;  // of the wall, by level
  std::vector<int> levels(mesh.groups.size(), 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const int level = levelOf(mesh, mesh.triangle[t], cells, scale);
    const std::uint32_t group = mesh.group[t];
    if (mesh.groups[group].kind != FaceKind::Wall) {
      levels[group] = std::max(levels[group], level);
      continue;
    }
    const auto [at, isNew] = groupOf.emplace(level, group);
    if (isNew && groupOf.size() > 1) {
      at->second = static_cast<std::uint32_t>(mesh.groups.size());
      mesh.groups.push_back({"wall-" + std::to_string(groupOf.size()), FaceKind::Wall});
      levels.push_back(0);
    }
    mesh.group[t] = at->second;
    levels[at->second] = level;
  }
  return levels;
}

std::vector<FoamPatch> foamPatches(const SurfaceMesh& mesh, const std::vector<int>& levels,
                                   const std::vector<NamedEnd>& ends) {
  const std::vector<std::string> names = distinct(plainGroupNames(mesh.groups), openFoamWord);
  std::vector<FoamPatch> patches;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (std::find(mesh.group.begin(), mesh.group.end(), g) == mesh.group.end()) continue;
    FoamPatch patch;
    patch.end = mesh.groups[g].name;
    patch.name = names[g];
    patch.kind = mesh.groups[g].kind == FaceKind::Cap ? FaceKind::Wall : mesh.groups[g].kind;
    patch.level = levels[g];
    for (const NamedEnd& end : ends)
      if (end.name == patch.end) patch.radius = end.radius;
    patches.push_back(std::move(patch));
  }
  return patches;
}

std::vector<std::string> assignFlows(std::vector<FoamPatch>& patches, const FlowNetwork& network) {
  for (const FlowTree& tree : network.trees) {
    FlowPart part = partOf(patches, network, tree);
    if (!part.inlets.empty() && !part.outlets.empty())
      share(part);
    else
      for (FoamPatch* inlet : part.inlets) inlet->flow = 0;
  }
  std::vector<std::string> losses;
  bool flows = false;
  for (FoamPatch& patch : patches) {
    if (patch.kind == FaceKind::Wall) continue;
    flows = flows || patch.flow > 0;
    if (patch.flow > 0) continue;
    losses.push_back(patch.end + ": no flat " +
                     (patch.kind == FaceKind::Inlet ? "outlet" : "inlet") +
                     " is connected to this end, so it is a wall");
    patch.kind = FaceKind::Wall;
  }
  if (!flows)
    throw invalidInput(
        "the surface of this case has no flat inlet with a flat outlet behind it, so nothing can "
        "flow through it");
  setDrops(patches, network);
  return losses;
}

}  // namespace lumen::convert
