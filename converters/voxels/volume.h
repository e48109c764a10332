// SPDX-License-Identifier: Apache-2.0
// Scalar volume in memory, in the precision of its file.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Dense>

#include "converters/voxels/cell_box.h"

namespace lumen::convert {

/// Index space to LPS millimetres: world = origin + direction * diag(spacing) * index; the origin
/// is the centre of voxel (0,0,0) (ITK's convention).
struct VolumeGeometry {
  std::array<int, 3> size{};                                ///< voxels along i (fastest), j, k
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();        ///< mm, > 0
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();         ///< mm, LPS
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();  ///< orthonormal columns
  /// For each voxel whether it is image; null: all are (continueImage()).
  std::shared_ptr<const std::vector<bool>> image{};

  [[nodiscard]] Eigen::Vector3d worldFromIndex(const Eigen::Vector3d& index) const {
    return origin + direction * spacing.cwiseProduct(index);
  }
  [[nodiscard]] Eigen::Vector3d indexFromWorld(const Eigen::Vector3d& world) const {
    return (direction.transpose() * (world - origin)).cwiseQuotient(spacing);
  }
  /// True for index positions within the voxel centres' box, [0, size - 1] on each axis, whose
  /// nearest voxel is image.
  [[nodiscard]] bool containsIndex(const Eigen::Vector3d& index) const {
    for (int a = 0; a < 3; ++a)
      if (!(index[a] >= 0 && index[a] <= size[static_cast<std::size_t>(a)] - 1)) return false;
    return !image || isImage(this->index(nearestCell(index)));
  }
  [[nodiscard]] bool containsWorld(const Eigen::Vector3d& world) const {
    return containsIndex(indexFromWorld(world));
  }
  /// Geometric mean of the spacing, mm: the size of "a voxel" as a length.
  [[nodiscard]] double voxelSize() const { return std::cbrt(spacing.prod()); }

  /// All cells of the volume.
  [[nodiscard]] CellBox cells() const { return {Cell::Zero(), {size[0], size[1], size[2]}}; }
  [[nodiscard]] std::size_t voxelCount() const { return cells().count(); }
  [[nodiscard]] bool contains(const Cell& cell) const { return cells().contains(cell); }
  [[nodiscard]] bool isImage(std::size_t voxel) const { return !image || (*image)[voxel]; }
  /// True for a cell of the volume that shares a face with a voxel that is no image.
  [[nodiscard]] bool isBesideNoImage(const Cell& cell) const {
    return image && std::any_of(kFaceSteps.begin(), kFaceSteps.end(), [&](const Cell& step) {
             return contains(cell + step) && !isImage(index(cell + step));
           });
  }
  static Cell nearestCell(const Eigen::Vector3d& index) {
    return index.array().round().cast<int>().matrix();
  }
  /// The index of a cell among the voxels.
  [[nodiscard]] std::size_t index(const Cell& cell) const { return cells().index(cell); }
  [[nodiscard]] Cell cell(std::size_t index) const { return cells().cell(index); }
  /// The centre of a voxel, mm, LPS.
  [[nodiscard]] Eigen::Vector3d position(const Cell& cell) const {
    return worldFromIndex(cell.cast<double>());
  }
  /// The cells within a box in index space, clipped to the volume.
  [[nodiscard]] CellBox cellsAround(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;
};

/// Cells rounded outward, and moved to the volume's rim where a corner lies beyond it.
inline CellBox VolumeGeometry::cellsAround(const Eigen::Vector3d& low,
                                           const Eigen::Vector3d& high) const {
  Cell first, last;
  for (int a = 0; a < 3; ++a) {
    const double end = size[static_cast<std::size_t>(a)] - 1;
    first[a] = static_cast<int>(std::clamp(std::floor(low[a]), 0.0, end));
    last[a] = static_cast<int>(std::clamp(std::ceil(high[a]), 0.0, end));
  }
  return CellBox::between(first, last);
}

/// Voxels x fastest. Pixel types that are not listed are widened on reading (int8 to int16; 32-bit
/// and wider integers and doubles to float).
using Voxels = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>,
                            std::vector<std::uint16_t>, std::vector<float>>;

struct Volume {
  VolumeGeometry geometry;
  Voxels voxels;
  /// Assumptions of the reader where the file is incomplete (VolumeHeader::assumptions).
  std::vector<std::string> assumptions{};
  /// The least and the greatest value of what is no image, where the file states it.
  std::optional<std::array<float, 2>> padding{};
};

}  // namespace lumen::convert
