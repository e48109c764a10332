// SPDX-License-Identifier: Apache-2.0
#include "converters/surface/surface_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

constexpr double kStraight = 0.02;  // of the radius: so near to the wall, one evaluation tells

}  // namespace

double distanceToField(const SheetField& field, const Eigen::Vector3d& point, std::uint32_t node) {
  const SheetSample sample = field.at(point, node);
  if (std::abs(sample.distance) > kStraight * field.radius(sample.node))
    if (const auto foot = field.project(point, node)) return (foot->position - point).norm();
  return std::abs(sample.distance);
}

SurfaceError surfaceError(const CaseSurface& surface, const SheetField& field) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<std::uint8_t> isFlat(surface.groups.size(), 0);
  for (const SurfaceEnd& end : surface.ends)
    isFlat[end.group] = surface.groups[end.group].kind != FaceKind::Cap ? 1 : 0;
  // Of each triangle: at its corners and edges, and in its middle.
  std::vector<double> outline(mesh.triangle.size(), 0), middle(mesh.triangle.size(), 0),
      area(mesh.triangle.size(), 0);
  tbb::parallel_for(std::size_t{0}, mesh.triangle.size(), [&](std::size_t f) {
    if (isFlat[surface.group[f]] != 0) return;
    const Triangle& t = mesh.triangle[f];
    const auto &a = mesh.position[t[0]], &b = mesh.position[t[1]], &c = mesh.position[t[2]];
    area[f] = (b - a).cross(c - a).norm() / 2;
    middle[f] = distanceToField(field, (a + b + c) / 3, surface.node[t[0]]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], w = t[(i + 1) % 3];
      if (v > w) continue;  // the triangle on the other side has it
      const Eigen::Vector3d &p = mesh.position[v], &q = mesh.position[w];
      outline[f] = std::max({outline[f], distanceToField(field, p, surface.node[v]),
                             distanceToField(field, 0.5 * (p + q), surface.node[v])});
    }
  });
  SurfaceError error;
  double squares = 0, areas = 0;
  for (std::size_t f = 0; f < area.size(); ++f) {
    error.largest = std::max({error.largest, outline[f], middle[f]});
    squares += area[f] * middle[f] * middle[f];
    areas += area[f];
  }
  error.rms = areas > 0 ? std::sqrt(squares / areas) : 0;
  return error;
}

}  // namespace lumen::convert
