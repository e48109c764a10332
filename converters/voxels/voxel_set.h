// SPDX-License-Identifier: Apache-2.0
// Subset of a volume's voxels, and their neighbourhood.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "converters/voxels/volume.h"

namespace lumen::convert {

/// Voxels, numbered from 0 in the order of their indices (x fastest).
class VoxelSet {
public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// `indices`: ascending, each once, fewer than kNone. `geometry` must outlive the set.
  VoxelSet(const VolumeGeometry& geometry, std::vector<std::size_t> indices);

  [[nodiscard]] std::size_t size() const { return m_indices.size(); }
  [[nodiscard]] std::size_t index(std::uint32_t i) const { return m_indices[i]; }
  [[nodiscard]] Cell cell(std::uint32_t i) const { return m_geometry.cell(m_indices[i]); }
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t i) const {  ///< mm, LPS
    return m_geometry.position(cell(i));
  }
  /// The number of a voxel; kNone if it is not in the set.
  [[nodiscard]] std::uint32_t find(std::size_t index) const;
  [[nodiscard]] const VolumeGeometry& geometry() const { return m_geometry; }

  /// Calls visit(j, step) for each voxel of the set that shares a corner with `i`; `step` is the
  /// vector to it in mm along the axes of the grid.
  template <class Visit>
  void eachBeside(std::uint32_t i, Visit&& visit) const {
    eachInBox(cell(i), Cell::Ones(), [&](std::uint32_t j, const Eigen::Vector3d& step) {
      if (j != i) visit(j, step);
    });
  }

  /// Calls visit(j) for each voxel of the set within `mm` of `i`, `i` itself too.
  template <class Visit>
  void eachWithin(std::uint32_t i, double mm, Visit&& visit) const {
    const Eigen::Array3d most = m_geometry.cells().size.cast<double>();
    const Cell reach = (mm / m_geometry.spacing.array()).min(most).cast<int>().matrix();
    eachInBox(cell(i), reach, [&](std::uint32_t j, const Eigen::Vector3d& step) {
      if (step.squaredNorm() <= mm * mm) visit(j);
    });
  }

  /// Calls visit(j) for each voxel of the set within `mm` of a point, mm, LPS.
  template <class Visit>
  void eachIn(const Eigen::Vector3d& centre, double mm, Visit&& visit) const {
    const Cell at = m_geometry.indexFromWorld(centre).array().round().cast<int>().matrix();
    const Eigen::Array3d most = m_geometry.cells().size.cast<double>();
    const Cell reach =
        ((mm / m_geometry.spacing.array()).ceil() + 1).min(most).cast<int>().matrix();
    eachInBox(at, reach, [&](std::uint32_t j, const Eigen::Vector3d&) {
      if ((position(j) - centre).squaredNorm() <= mm * mm) visit(j);
    });
  }

private:
  template <class Visit>
  void eachInBox(const Cell& at, const Cell& reach, Visit&& visit) const {
    const CellBox cells = m_geometry.cells();
    const auto nx = static_cast<std::size_t>(cells.size[0]),
               ny = static_cast<std::size_t>(cells.size[1]);
    const Cell low = (at - reach).cwiseMax(0), high = (at + reach).cwiseMin(cells.high());
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const std::size_t row = static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y);
        const std::size_t first = row * nx;
        for (std::uint32_t j = lowerBound(row, first + static_cast<std::size_t>(low[0]));
             j < m_rows[row + 1]; ++j) {
          const int x = static_cast<int>(m_indices[j] - first);
          if (x > high[0]) break;
          visit(j, Eigen::Vector3d(
                       m_geometry.spacing.cwiseProduct((Cell(x, y, z) - at).cast<double>())));
        }
      }
  }
  [[nodiscard]] std::uint32_t lowerBound(std::size_t row, std::size_t index) const {
    const auto begin = m_indices.begin();
    return static_cast<std::uint32_t>(
        std::lower_bound(begin + m_rows[row], begin + m_rows[row + 1], index) - begin);
  }

  const VolumeGeometry& m_geometry;
  std::vector<std::size_t> m_indices;
  std::vector<std::uint32_t> m_rows;  ///< start of each row of voxels, and the end
};

}  // namespace lumen::convert
