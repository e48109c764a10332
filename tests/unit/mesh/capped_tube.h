// SPDX-License-Identifier: Apache-2.0
// A closed synthetic surface with everything that writers take.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "converters/io/mesh/surface_mesh.h"

namespace lumen::test {

/// Labels that no format may stumble over.
inline std::vector<std::string> hostileLabels() {
  return {"a\nsolid b\rc",
          "</DataArray>\"&<x>",
          "c\u00f4t\u00e9 \u8840\u7ba1",
          std::string(250, 'x'),
          "tab\there",
          "tab here",
          "$(rm -rf /);{}",
          "\\"};
}

/// A prism with `around` corners along z, 4 mm long with `rings` rings of edges, of radius 1 mm:
/// group 0 its wall, group 1 the inlet at z = 0, group 2 the outlet. The flat ends have a vertex in
/// their middle. The first of `labels` is the lower half's, the last the upper half's; the groups of
/// the ends are called after these.
inline convert::SurfaceMesh cappedTube(const std::vector<std::string>& labels, int around = 12,
                                       int rings = 4) {
  convert::SurfaceMesh mesh;
  mesh.labels = labels;
  mesh.groups = {{"wall", convert::FaceKind::Wall},
                 {"inlet-" + labels.front(), convert::FaceKind::Inlet},
                 {"outlet-" + labels.back(), convert::FaceKind::Outlet}};
  const auto last = static_cast<std::uint32_t>(labels.size() - 1);
  const auto add = [&](const convert::Float3& position, const convert::Float3& normal) {
    mesh.position.push_back(position);
    mesh.normal.push_back(normal);
    mesh.radius.push_back(1 + 0.1F * position[2]);
    mesh.confidence.push_back(1 - 0.2F * position[2]);
    mesh.branch.push_back(position[2] < 2 ? 0 : last);
    return static_cast<std::uint32_t>(mesh.position.size() - 1);
  };
  const auto face = [&](std::uint32_t group, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangle.push_back({a, b, c});
    mesh.group.push_back(group);
  };
  for (int k = 0; k <= rings; ++k)
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      const auto x = static_cast<float>(std::cos(turn)), y = static_cast<float>(std::sin(turn));
      add({x, y, 4.0F * static_cast<float>(k) / static_cast<float>(rings)}, {x, y, 0});
    }
  const std::uint32_t low = add({0, 0, 0}, {0, 0, -1}), high = add({0, 0, 4}, {0, 0, 1});
  const auto at = [&](int ring, int i) {
    return static_cast<std::uint32_t>(ring * around + i % around);
  };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < rings; ++k) {
      face(0, at(k, i), at(k, i + 1), at(k + 1, i + 1));
      face(0, at(k, i), at(k + 1, i + 1), at(k + 1, i));
    }
    face(1, low, at(0, i + 1), at(0, i));
    face(2, high, at(rings, i), at(rings, i + 1));
  }
  return mesh;
}

/// cappedTube() without its ends.
inline convert::SurfaceMesh openTube(const std::vector<std::string>& labels) {
  convert::SurfaceMesh mesh = cappedTube(labels);
  std::vector<convert::Triangle> triangle;
  for (std::size_t f = 0; f < mesh.triangle.size(); ++f)
    if (mesh.group[f] == 0) triangle.push_back(mesh.triangle[f]);
  mesh.triangle = triangle;
  mesh.group.assign(triangle.size(), 0);
  return mesh;
}

}  // namespace lumen::test
