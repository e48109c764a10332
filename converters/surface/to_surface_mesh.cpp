// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/to_surface_mesh.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/surface/vessel_values.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
// Vertices between two looks at whether the user has cancelled.
constexpr std::size_t kBatch = 256;

Float3 toFloat3(const Eigen::Vector3d& v) {
  const Eigen::Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z()};
}

/// Of each vertex the end that all of its triangles are of, as an index into the ends; kNone if there
/// is none, or if that end is not flat.
std::vector<std::uint32_t> flatEnds(const CaseSurface& surface) {
  std::vector<std::uint32_t> endOfGroup(surface.groups.size(), kNone);
  for (std::uint32_t e = 0; e < surface.ends.size(); ++e) {
    const std::uint32_t group = surface.ends[e].group;
    const FaceKind kind = surface.groups[group].kind;
    if (kind == FaceKind::Inlet || kind == FaceKind::Outlet) endOfGroup[group] = e;
  }
  constexpr std::uint32_t kUnseen = kNone - 1;
  std::vector<std::uint32_t> end(surface.mesh.position.size(), kUnseen);
  for (std::size_t f = 0; f < surface.mesh.triangle.size(); ++f) {
    const std::uint32_t own = endOfGroup[surface.group[f]];
    for (const std::uint32_t v : surface.mesh.triangle[f])
      end[v] = end[v] == kUnseen || end[v] == own ? own : kNone;
  }
  for (std::uint32_t& e : end)
    if (e == kUnseen) e = kNone;
  return end;
}

}  // namespace

SurfaceMesh toSurfaceMesh(const CaseSurface& surface, const SheetField& field, Progress& progress) {
  const formats::CenterlineTree& tree = field.source().tree;
  const formats::Neighbours edges(tree);
  const std::vector<std::uint32_t> end = flatEnds(surface);
  const std::vector<Eigen::Vector3d>& position = surface.mesh.position;
  SurfaceMesh result;
  result.triangle = surface.mesh.triangle;
  result.group = surface.group;
  result.groups = surface.groups;
  for (const formats::Branch& branch : tree.branches) result.labels.push_back(branch.label);
  result.position.resize(position.size());
  result.normal.resize(position.size());
  result.radius.resize(position.size());
  result.branch.resize(position.size());
  if (!tree.inlierRate.empty()) result.confidence.resize(position.size());
  tbb::parallel_for(std::size_t{0}, position.size(), [&](std::size_t v) {
    if (v % kBatch == 0) progress.check();
    const std::uint32_t node = surface.node[v];
    const Eigen::Vector3d normal =
        end[v] != kNone ? surface.ends[end[v]].normal : field.at(position[v], node).gradient;
    const VesselValues values = vesselAt(tree, edges, position[v], node);
    result.position[v] = toFloat3(position[v]);
    result.normal[v] = toFloat3(normal);
    result.radius[v] = values.radius;
    result.branch[v] = tree.branch[node];
    if (values.confidence) result.confidence[v] = *values.confidence;
  });
  return result;
}

}  // namespace lumen::convert
