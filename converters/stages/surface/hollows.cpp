// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/hollows.h"

#include <cstdint>
#include <vector>

#include "converters/geometry/disjoint_sets.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/stages/surface/surface_fans.h"

namespace lumen::convert {

std::size_t dropHollows(CaseSurface& surface) {
  const TriangleMesh& mesh = surface.mesh;
  DisjointSets sets(mesh.position.size());
  for (const Triangle& t : mesh.triangle) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<double> volume(mesh.position.size(), 0);
  for (const Triangle& t : mesh.triangle) {
    const std::uint32_t part = sets.find(t[0]);
    const Eigen::Vector3d& origin = mesh.position[part];
    volume[part] += tetrahedronVolume(mesh.position[t[0]] - origin, mesh.position[t[1]] - origin,
                                      mesh.position[t[2]] - origin);
  }
  std::size_t dropped = 0;
  for (const double of : volume) dropped += of < 0 ? 1 : 0;
  if (dropped == 0) return 0;
  SurfaceFans fans(surface);
  const auto count = static_cast<std::uint32_t>(mesh.triangle.size());
  for (std::uint32_t t = 0; t < count; ++t)
    if (volume[sets.find(mesh.triangle[t][0])] < 0) fans.remove(t);
  fans.compact();
  return dropped;
}

}  // namespace lumen::convert
