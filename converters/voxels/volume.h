// SPDX-License-Identifier: Apache-2.0
// A scalar volume in memory, in the precision of its file.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Dense>

namespace lumen::convert {

/// Index space to LPS millimetres: world = origin + direction * diag(spacing) * index; the origin
/// is the centre of voxel (0,0,0) (ITK's convention).
struct VolumeGeometry {
  std::array<int, 3> size{};                                ///< voxels along i (fastest), j, k
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();        ///< mm, > 0
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();         ///< mm, LPS
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();  ///< orthonormal columns

  [[nodiscard]] Eigen::Vector3d worldFromIndex(const Eigen::Vector3d& index) const {
    return origin + direction * spacing.cwiseProduct(index);
  }
  [[nodiscard]] Eigen::Vector3d indexFromWorld(const Eigen::Vector3d& world) const {
    return (direction.transpose() * (world - origin)).cwiseQuotient(spacing);
  }
  /// True for index positions within the voxel centres' box, [0, size - 1] on each axis.
  [[nodiscard]] bool containsIndex(const Eigen::Vector3d& index) const {
    for (int a = 0; a < 3; ++a)
      if (!(index[a] >= 0 && index[a] <= size[static_cast<std::size_t>(a)] - 1)) return false;
    return true;
  }
  [[nodiscard]] bool containsWorld(const Eigen::Vector3d& world) const {
    return containsIndex(indexFromWorld(world));
  }
  /// Geometric mean of the spacing, mm: what "a voxel" means wherever a length is tied to one.
  [[nodiscard]] double voxelSize() const { return std::cbrt(spacing.prod()); }
  [[nodiscard]] std::size_t voxelCount() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
};

/// Voxels x fastest. Pixel types that are not listed are widened on reading (int8 to int16; 32-bit
/// and wider integers and doubles to float).
using Voxels = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>,
                            std::vector<std::uint16_t>, std::vector<float>>;

struct Volume {
  VolumeGeometry geometry;
  Voxels voxels;
  /// What its file left open and the reader assumed (VolumeHeader::assumptions).
  std::vector<std::string> assumptions{};
};

}  // namespace lumen::convert
