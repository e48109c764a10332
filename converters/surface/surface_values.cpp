// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/surface_values.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/surface/vessel_values.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

// Sums of the normals of triangles, by their areas: first of the wall, then, where there is none, of
// ends.
std::vector<Eigen::Vector3d> normalsOf(const CaseSurface& surface) {
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

Float3 toFloat3(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

SurfaceMesh surfaceMeshOf(const CaseSurface& surface, const formats::Case& source) {
  const formats::Neighbours edges(source.tree);
  const std::vector<Eigen::Vector3d> normal = normalsOf(surface);
  const std::size_t count = surface.mesh.position.size();
  SurfaceMesh mesh;
  mesh.position.resize(count);
  mesh.normal.resize(count);
  mesh.radius.resize(count);
  mesh.branch.resize(count);
  if (!source.tree.inlierRate.empty()) mesh.confidence.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    const VesselValues values =
        vesselAt(source.tree, edges, surface.mesh.position[v], surface.node[v]);
    mesh.position[v] = toFloat3(surface.mesh.position[v]);
    mesh.normal[v] = toFloat3(normal[v]);
    mesh.radius[v] = values.radius;
    mesh.branch[v] = source.tree.branch[surface.node[v]];
    if (!mesh.confidence.empty()) mesh.confidence[v] = *values.confidence;
  });
  mesh.triangle = surface.mesh.triangle;
  mesh.group = surface.group;
  mesh.groups = surface.groups;
  for (const formats::Branch& branch : source.tree.branches) mesh.labels.push_back(branch.label);
  return mesh;
}

}  // namespace lumen::convert
