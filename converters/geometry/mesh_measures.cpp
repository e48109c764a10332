// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/mesh_measures.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

constexpr double kFlat = 1e-6;  // height over length; coordinates of f32 have about 1e-7

}  // namespace

bool isDegenerate(const TriangleMesh& mesh, const Triangle& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    longest =
        std::max(longest, (mesh.position[t[i]] - mesh.position[t[(i + 1) % 3]]).squaredNorm());
  return 2 * vectorArea(mesh, t).norm() <= kFlat * longest;
}

double signedVolume(const TriangleMesh& mesh) {
  if (mesh.position.empty()) return 0;
  const Eigen::Vector3d origin = mesh.position.front();
  double volume = 0;
  for (const Triangle& t : mesh.triangle) {
    const Eigen::Vector3d& a = mesh.position[t[0]];
    const Eigen::Vector3d across = (mesh.position[t[1]] - a).cross(mesh.position[t[2]] - a);
    volume += (a - origin).dot(across) / 6;
  }
  return volume;
}

Box3d boundingBox(const TriangleMesh& mesh) {
  Box3d box;
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) box.add(mesh.position[v]);
  if (mesh.triangle.empty()) box.add(Eigen::Vector3d::Zero());
  return box;
}

}  // namespace lumen::convert
