// SPDX-License-Identifier: Apache-2.0
// Prisms as tetrahedra. Declared in volume_mesh.h.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "converters/io/mesh/volume_mesh.h"

namespace lumen::convert {

namespace {

using Tetrahedron = std::array<std::uint32_t, 4>;

/// The prism turned so that its corner with the least number is the first one. A prism that is turned
/// upside down has its other triangle first, in the sense that is then seen from outside.
std::array<std::uint32_t, 6> turned(const std::array<std::uint32_t, 6>& p) {
  constexpr std::array<std::array<std::size_t, 6>, 6> kTurns{{{0, 1, 2, 3, 4, 5},
                                                              {1, 2, 0, 4, 5, 3},
                                                              {2, 0, 1, 5, 3, 4},
                                                              {3, 5, 4, 0, 2, 1},
                                                              {4, 3, 5, 1, 0, 2},
                                                              {5, 4, 3, 2, 1, 0}}};
  const auto& turn =
      kTurns[static_cast<std::size_t>(std::min_element(p.begin(), p.end()) - p.begin())];
  std::array<std::uint32_t, 6> result{};
  for (std::size_t k = 0; k < 6; ++k) result[k] = p[turn[k]];
  return result;
}

/// Both quadrilaterals at the least corner are divided from it; the third one, 1 2 5 4, from its own
/// least corner.
std::array<Tetrahedron, 3> divided(const std::array<std::uint32_t, 6>& prism) {
  const auto p = turned(prism);
  const bool fromFirst = std::min(p[1], p[5]) < std::min(p[2], p[4]);
  if (fromFirst)
    return {{{p[0], p[2], p[1], p[5]}, {p[0], p[5], p[1], p[4]}, {p[0], p[5], p[4], p[3]}}};
  return {{{p[0], p[2], p[1], p[4]}, {p[0], p[5], p[2], p[4]}, {p[0], p[5], p[4], p[3]}}};
}

}  // namespace

VolumeMesh asTetrahedra(const VolumeMesh& mesh) {
  VolumeMesh result;
  result.position = mesh.position;
  result.groups = mesh.groups;
  for (const auto& prism : mesh.prism)
    for (const Tetrahedron& t : divided(prism)) result.tetrahedron.push_back(t);
  result.tetrahedron.insert(result.tetrahedron.end(), mesh.tetrahedron.begin(),
                            mesh.tetrahedron.end());
  for (const BoundaryFace& face : mesh.boundary) {
    const FaceCorners& c = face.corner;
    if (c[3] == kAbsent) {
      result.boundary.push_back(face);
      continue;
    }
    const auto at = static_cast<std::size_t>(std::min_element(c.begin(), c.end()) - c.begin());
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
      result.boundary.push_back(
          {{c[at], c[(at + k) % 4], c[(at + k + 1) % 4], kAbsent}, face.group});
  }
  return result;
}

}  // namespace lumen::convert
