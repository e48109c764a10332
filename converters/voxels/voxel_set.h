// SPDX-License-Identifier: Apache-2.0
// Some of a volume's voxels, and which of them are neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

  /// `indices`: ascending, each once, fewer than kNone. `geometry` must stay.
  VoxelSet(const VolumeGeometry& geometry, std::vector<std::size_t> indices);

  [[nodiscard]] std::size_t size() const { return m_indices.size(); }
  [[nodiscard]] std::size_t index(std::uint32_t i) const { return m_indices[i]; }
  [[nodiscard]] std::array<int, 3> place(std::uint32_t i) const;
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t i) const {  ///< mm, LPS
    const auto p = place(i);
    return m_geometry.worldFromIndex({double(p[0]), double(p[1]), double(p[2])});
  }
  /// kNone if it is not in the set.
  [[nodiscard]] std::uint32_t find(std::size_t index) const;
  [[nodiscard]] const VolumeGeometry& geometry() const { return m_geometry; }

  /// Calls visit(j, way) for each voxel of the set that shares a corner with `i`: the way there in mm
  /// along the axes of the grid.
  template <class Visit>
  void eachBeside(std::uint32_t i, Visit&& visit) const {
    eachInBox(place(i), {1, 1, 1}, [&](std::uint32_t j, const Eigen::Vector3d& way) {
      if (j != i) visit(j, way);
    });
  }

  /// Calls visit(j) for each voxel of the set within `mm` of `i`, `i` itself too.
  template <class Visit>
  void eachWithin(std::uint32_t i, double mm, Visit&& visit) const {
    std::array<int, 3> reach{};
    for (int a = 0; a < 3; ++a)
      reach[static_cast<std::size_t>(a)] = static_cast<int>(mm / m_geometry.spacing[a]);
    eachInBox(place(i), reach, [&](std::uint32_t j, const Eigen::Vector3d& way) {
      if (way.squaredNorm() <= mm * mm) visit(j);
    });
  }

private:
  template <class Visit>
  void eachInBox(const std::array<int, 3>& at, const std::array<int, 3>& reach,
                 Visit&& visit) const {
    const auto& size = m_geometry.size;
    const int lowX = std::max(at[0] - reach[0], 0), highX = std::min(at[0] + reach[0], size[0] - 1);
    for (int z = std::max(at[2] - reach[2], 0); z <= std::min(at[2] + reach[2], size[2] - 1); ++z)
      for (int y = std::max(at[1] - reach[1], 0); y <= std::min(at[1] + reach[1], size[1] - 1);
           ++y) {
        const std::size_t row = rowOf(y, z), first = row * static_cast<std::size_t>(size[0]);
        for (std::uint32_t j = lowerBound(row, first + static_cast<std::size_t>(lowX));
             j < m_rows[row + 1]; ++j) {
          const int x = static_cast<int>(m_indices[j] - first);
          if (x > highX) break;
          visit(j, Eigen::Vector3d(m_geometry.spacing.cwiseProduct(
                       Eigen::Vector3d(x - at[0], y - at[1], z - at[2]))));
        }
      }
  }
  [[nodiscard]] std::size_t rowOf(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(m_geometry.size[1]) +
           static_cast<std::size_t>(y);
  }
  [[nodiscard]] std::uint32_t lowerBound(std::size_t row, std::size_t index) const {
    const auto begin = m_indices.begin();
    return static_cast<std::uint32_t>(
        std::lower_bound(begin + m_rows[row], begin + m_rows[row + 1], index) - begin);
  }

  const VolumeGeometry& m_geometry;
  std::vector<std::size_t> m_indices;
  std::vector<std::uint32_t> m_rows;  ///< where each row of voxels begins, and the end
};

}  // namespace lumen::convert
