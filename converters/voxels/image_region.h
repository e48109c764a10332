// SPDX-License-Identifier: Apache-2.0
// Voxels of a volume that are image, and not what fills the rest (docs/method.md, section 1.13).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The image within a volume. Without a border in the volume it holds all voxels, and no copy.
struct ImageRegion {
  std::vector<bool> isImage{};           ///< for each voxel; empty: all are
  std::optional<Volume> continued{};     ///< the volume with the image continued over the rest
  std::vector<std::string> sentences{};  ///< on each value that is no image

  [[nodiscard]] bool holds(std::size_t voxel) const { return isImage.empty() || isImage[voxel]; }
  /// True for a cell that shares a face with a voxel that is not image.
  [[nodiscard]] bool isBeside(const CellBox& cells, const Cell& cell) const;
  /// `whole`, or the volume in which no border of its image shows.
  [[nodiscard]] const Volume& without(const Volume& whole) const {
    return continued ? *continued : whole;
  }
};

/// The image within a volume. These voxels are none: those of a corner's value that are connected
/// with a face of the volume, if the image beside them is noisy, does not fade into that value, and
/// is thick. Throws Error(Cancelled).
ImageRegion findImage(const Volume& volume, const Progress& progress);

}  // namespace lumen::convert
