// SPDX-License-Identifier: Apache-2.0
// A triangle mesh as every writer takes it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/mesh/surface_mesh.h"

namespace lumen::convert {

/// What the mesh of a branch lacks of its surface.
struct BranchLosses {
  std::size_t nodes = 0;  ///< that have a model
  /// of those, the ones whose lumen no corner of a cell lies in: the cells are too coarse for them
  std::size_t missedNodes = 0;
  std::size_t lostTriangles = 0;  ///< dropped where the surface of the case is not near
  double thinnest = 0;            ///< the least radius of nodes with such losses, mm
  [[nodiscard]] bool any() const { return missedNodes > 0 || lostTriangles > 0; }
};

/// The wall of one branch. Each patch in it is an oriented 2-manifold with boundary.
struct BranchMesh {
  std::string label;
  std::vector<Float3> position;    ///< mm, LPS
  std::vector<Float3> normal;      ///< unit, out of the lumen; one for each position
  std::vector<Triangle> triangle;  ///< indices of positions, counter-clockwise seen from outside
  BranchLosses losses{};
};

/// Widens the box `low` .. `high` so that it holds `point`.
inline void extendBox(const Float3& point, Float3& low, Float3& high) {
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::min(low[a], point[a]);
    high[a] = std::max(high[a], point[a]);
  }
}

}  // namespace lumen::convert
