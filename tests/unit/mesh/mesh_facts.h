// SPDX-License-Identifier: Apache-2.0
// Facts of a triangle mesh that tests need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/surface/patches/patch.h"

namespace lumen::test {

inline convert::TriangleMesh toPatch(const convert::SurfaceMesh& mesh) {
  convert::TriangleMesh patch;
  for (const convert::Float3& p : mesh.position) patch.position.emplace_back(p[0], p[1], p[2]);
  patch.triangle = mesh.triangle;
  return patch;
}

struct MeshFacts {
  std::ptrdiff_t euler = 0;          ///< vertices - edges + faces
  std::size_t boundaryEdges = 0;     ///< edges of one face
  std::size_t badEdges = 0;          ///< of more than two faces, or of two that disagree
  double volume = 0, area = 0;       ///< mm^3, mm^2
  std::set<std::uint32_t> boundary;  ///< vertices of boundary edges
};

inline MeshFacts measureFacts(const convert::TriangleMesh& patch) {
  MeshFacts facts;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const convert::Triangle& t : patch.triangle) {
    const auto &a = patch.position[t[0]], &b = patch.position[t[1]], &c = patch.position[t[2]];
    facts.volume += a.dot(b.cross(c)) / 6;
    facts.area += (b - a).cross(c - a).norm() / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], w = t[(i + 1) % 3];
      ++directed[{v, w}];
      edges.insert({std::min(v, w), std::max(v, w)});
    }
  }
  for (const auto& [v, w] : edges) {
    const auto forth = directed.find({v, w}), back = directed.find({w, v});
    const int nForth = forth == directed.end() ? 0 : forth->second;
    const int nBack = back == directed.end() ? 0 : back->second;
    if (nForth + nBack == 1) {
      ++facts.boundaryEdges;
      facts.boundary.insert({v, w});
    } else if (nForth != 1 || nBack != 1) {
      ++facts.badEdges;
    }
  }
  facts.euler = static_cast<std::ptrdiff_t>(patch.position.size()) -
                static_cast<std::ptrdiff_t>(edges.size()) +
                static_cast<std::ptrdiff_t>(patch.triangle.size());
  return facts;
}

}  // namespace lumen::test
