// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/to_surface_mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"
#include "formats/case/topology.h"

namespace lumen::convert {

VesselValues vesselAt(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
                      const Eigen::Vector3d& point, std::uint32_t node) {
  const Eigen::Vector3d from = toEigen(tree.centre[node]);
  double nearest = (point - from).squaredNorm(), share = 0;
  std::uint32_t other = node;
  for (const std::uint32_t neighbour : edges.of(node)) {
    const Eigen::Vector3d along = toEigen(tree.centre[neighbour]) - from;
    const double squared = along.squaredNorm();
    if (!(squared > 0)) continue;
    const double t = std::clamp((point - from).dot(along) / squared, 0.0, 1.0);
    const double distance = (point - from - t * along).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    share = t;
    other = neighbour;
  }
  const auto between = [&](const auto& values) {
    return static_cast<float>((1 - share) * double(values[node]) + share * double(values[other]));
  };
  VesselValues result{between(tree.radius), {}};
  if (!tree.inlierRate.empty()) result.confidence = between(tree.inlierRate);
  return result;
}

namespace {

constexpr std::size_t kBatch = 256;

Float3 toFloat3(const Eigen::Vector3d& v) {
  const Eigen::Vector3f f = v.cast<float>();
  return {f.x(), f.y(), f.z()};
}

/// Sums of the normals of triangles, by their areas: those of the wall, and those of ends where
/// there is none.
std::vector<Eigen::Vector3d> sumNormals(const CaseSurface& surface) {
  const std::vector<Eigen::Vector3d>& position = surface.mesh.position;
  std::vector<Eigen::Vector3d> normal(position.size(), Eigen::Vector3d::Zero());
  std::vector<bool> hasWall(position.size(), false);
  for (const bool ends : {false, true})
    for (std::size_t i = 0; i < surface.mesh.triangle.size(); ++i) {
      const Triangle& t = surface.mesh.triangle[i];
      const bool isWall = surface.groups[surface.group[i]].kind == FaceKind::Wall;
      if (isWall == ends) continue;
      const Eigen::Vector3d area =
          (position[t[1]] - position[t[0]]).cross(position[t[2]] - position[t[0]]);
      for (const std::uint32_t v : t) {
        if (ends && hasWall[v]) continue;
        normal[v] += area;
        if (!ends) hasWall[v] = true;
      }
    }
  for (Eigen::Vector3d& n : normal) n = n.norm() > 0 ? n.normalized() : Eigen::Vector3d::UnitZ();
  return normal;
}

}  // namespace

SurfaceMesh toSurfaceMesh(const CaseSurface& surface, const SheetField& field, Progress& progress) {
  const formats::CenterlineTree& tree = field.source().tree;
  const formats::Neighbours edges(tree);
  const std::vector<Eigen::Vector3d> normal = sumNormals(surface);
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
  result.node = surface.node;
  if (!tree.inlierRate.empty()) result.confidence.resize(position.size());
  tbb::parallel_for(std::size_t{0}, position.size(), [&](std::size_t v) {
    if (v % kBatch == 0) progress.check();
    const std::uint32_t node = surface.node[v];
    const VesselValues values = vesselAt(tree, edges, position[v], node);
    result.position[v] = toFloat3(position[v]);
    result.normal[v] = toFloat3(normal[v]);
    result.radius[v] = values.radius;
    result.branch[v] = tree.branch[node];
    if (values.confidence) result.confidence[v] = *values.confidence;
  });
  return result;
}

}  // namespace lumen::convert
