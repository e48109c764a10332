// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/voxel_set.h"

#include <utility>

namespace lumen::convert {

VoxelSet::VoxelSet(const VolumeGeometry& geometry, std::vector<std::size_t> indices)
    : m_geometry(geometry), m_indices(std::move(indices)) {
  const auto width = static_cast<std::size_t>(geometry.size[0]);
  const auto rows =
      static_cast<std::size_t>(geometry.size[1]) * static_cast<std::size_t>(geometry.size[2]);
  m_rows.reserve(rows + 1);
  for (std::size_t i = 0; i < m_indices.size(); ++i)
    while (m_rows.size() <= m_indices[i] / width) m_rows.push_back(static_cast<std::uint32_t>(i));
  m_rows.resize(rows + 1, static_cast<std::uint32_t>(m_indices.size()));
}

std::uint32_t VoxelSet::find(std::size_t index) const {
  const std::size_t row = index / static_cast<std::size_t>(m_geometry.size[0]);
  const std::uint32_t i = lowerBound(row, index);
  return i < m_rows[row + 1] && m_indices[i] == index ? i : kNone;
}

}  // namespace lumen::convert
