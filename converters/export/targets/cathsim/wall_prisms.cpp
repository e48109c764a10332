// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/cathsim/wall_prisms.h"

#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "converters/base/vectors.h"
#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

namespace {

Float3 floatsOf(const Eigen::Vector3d& v) {
  const Eigen::Vector3f f = v.cast<float>();
  return {f[0], f[1], f[2]};
}

/// Normals of the walls alone, by area, so that the rim of an open end looks along the wall's
/// normal.
std::vector<Eigen::Vector3d> wallNormals(const SurfaceMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.position.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (mesh.groups[mesh.group[t]].kind != FaceKind::Wall) continue;
    const auto& [a, b, c] = mesh.triangle[t];
    const Eigen::Vector3d o = toEigen(mesh.position[a]);
    const Eigen::Vector3d area =
        (toEigen(mesh.position[b]) - o).cross(toEigen(mesh.position[c]) - o);
    for (const std::uint32_t v : mesh.triangle[t]) normals[v] += area;
  }
  for (Eigen::Vector3d& normal : normals) normal.normalize();
  return normals;
}

std::vector<Float3> raised(const SurfaceMesh& mesh, double share, const InLumen& inLumen) {
  const std::vector<Eigen::Vector3d> normals = wallNormals(mesh);
  std::vector<Float3> upper(mesh.position.size());
  for (std::size_t v = 0; v < upper.size(); ++v) {
    const Eigen::Vector3d foot = toEigen(mesh.position[v]);
    const auto at = [&](double height) { return floatsOf(foot + height * normals[v]); };
    double height = share * mesh.radius[v];
    constexpr int kHalvings = 6;
    for (int k = 0; k < kHalvings && (inLumen(at(height)) || inLumen(at(height / 2))); ++k)
      height /= 2;
    upper[v] = at(height);
  }
  return upper;
}

double measureVolume(const SurfaceMesh& mesh) {
  double sum = 0;
  const Eigen::Vector3d origin = toEigen(mesh.position.front());
  for (const auto& [a, b, c] : mesh.triangle)
    sum += tetrahedronVolume(toEigen(mesh.position[a]) - origin, toEigen(mesh.position[b]) - origin,
                             toEigen(mesh.position[c]) - origin);
  return sum;
}

}  // namespace

std::vector<SurfaceMesh> wallPrisms(const SurfaceMesh& mesh, double share, double leastVolume,
                                    const InLumen& inLumen) {
  const std::vector<Float3> upper = raised(mesh, share, inLumen);
  // corners 0 to 2 are the triangle's, 3 to 5 those above them
  const std::vector<Triangle> faces = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                                       {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  std::vector<SurfaceMesh> prisms;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    if (mesh.groups[mesh.group[t]].kind != FaceKind::Wall) continue;
    SurfaceMesh prism;
    prism.groups = {{"wall", FaceKind::Wall}};
    prism.triangle = faces;
    prism.group.assign(faces.size(), 0);
    for (const std::uint32_t v : mesh.triangle[t]) prism.position.push_back(mesh.position[v]);
    for (const std::uint32_t v : mesh.triangle[t]) prism.position.push_back(upper[v]);
    prism.branch.assign(prism.position.size(), mesh.branch[mesh.triangle[t].front()]);
    prism.systems = mesh.systems;
    if (measureVolume(prism) >= leastVolume) prisms.push_back(std::move(prism));
  }
  return prisms;
}

}  // namespace lumen::convert
