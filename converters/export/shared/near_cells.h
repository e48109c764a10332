// SPDX-License-Identifier: Apache-2.0
// The part of a grid in which a wall may be nearer than its band.
#pragma once

#include <vector>

#include "converters/export/shared/distance_grid.h"

namespace lumen::convert {

/// Cells of four samples of a lattice or more, marked where they come within the band of the balls of
/// nodes in which all walls lie. Places are in mm, LPS.
class NearCells {
public:
  /// Cells near all nodes, or near those of a region. O(nodes, times the cells of a ball).
  NearCells(const GridSource& source, const Lattice& fine);

  /// False if no wall is within the band of a point of the lattice.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;

private:
  void mark(const Eigen::Vector3d& centre, double reach);
  [[nodiscard]] std::size_t indexOf(const std::array<int, 3>& cell) const;
  [[nodiscard]] std::array<int, 3> cellOf(const Eigen::Vector3d& point) const;

  Eigen::Vector3d m_first;
  double m_edge = 0;
  std::array<int, 3> m_size{};
  std::vector<char> m_isNear;
};

}  // namespace lumen::convert
