// SPDX-License-Identifier: Apache-2.0
// Blocks of a set of voxels, over which values are averaged.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include "converters/base/progress.h"
#include "converters/voxels/cell_box.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

/// Blocks of two voxels along an edge in which voxels of a set lie, numbered from 0. What is
/// measured at a block is measured in the cube of ten voxels around it.
class BoneBlocks {
public:
  /// The set must outlive the blocks.
  explicit BoneBlocks(const VoxelSet& set);

  [[nodiscard]] std::size_t size() const { return m_cell.size(); }
  [[nodiscard]] std::uint32_t blockOf(std::uint32_t voxel) const { return m_blockOf[voxel]; }
  /// The number of voxels in blocks.
  [[nodiscard]] std::size_t countVoxels(std::span<const std::uint32_t> blocks) const;
  /// Places of voxels in blocks, evenly chosen, `most` at most, mm, LPS.
  [[nodiscard]] std::vector<Eigen::Vector3d> points(std::span<const std::uint32_t> blocks,
                                                    std::size_t most) const;

  /// The mean of valueOf(voxel) around each block, over values that are finite, of every fourth
  /// voxel; not a number where most are not. Throws Error(Cancelled).
  template <class ValueOf>
  std::vector<double> localMeans(const ValueOf& valueOf, const Progress& progress) const {
    std::vector<float> values((m_blockOf.size() + kStride - 1) / kStride);
    constexpr std::size_t kChunk = 4096;
    tbb::parallel_for(std::size_t{0}, values.size() / kChunk + 1, [&](std::size_t chunk) {
      progress.check();
      const std::size_t end = std::min(values.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < end; ++i)
        values[i] = static_cast<float>(valueOf(static_cast<std::uint32_t>(kStride * i)));
    });
    return localMeansOf(values);
  }

  /// The connected group of blocks with `is` that has most voxels, ascending.
  template <class Is>
  std::vector<std::uint32_t> largestGroup(const Is& is) const {
    std::vector<bool> isWanted(size());
    for (std::uint32_t b = 0; b < size(); ++b) isWanted[b] = is(b);
    return largestOf(std::move(isWanted));
  }

private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  static constexpr std::size_t kStride = 4;
  [[nodiscard]] std::vector<double> localMeansOf(const std::vector<float>& values) const;
  [[nodiscard]] std::vector<std::uint32_t> largestOf(std::vector<bool> isWanted) const;

  const VoxelSet& m_set;
  CellBox m_blocks;
  std::vector<std::uint32_t> m_number;   ///< of each block of the box; kNone if it is empty
  std::vector<Cell> m_cell;              ///< of each block that is numbered
  std::vector<std::uint32_t> m_blockOf;  ///< of each voxel of the set
};

}  // namespace lumen::convert
