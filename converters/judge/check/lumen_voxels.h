// SPDX-License-Identifier: Apache-2.0
// The voxels whose centres lie inside a case.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"
#include "formats/field/blended_field.h"

namespace lumen::convert {

struct LumenVoxel {
  std::size_t index = 0;  ///< x fastest
  /// Node of a cursor that has the voxel inside; the node of least power, if there are several.
  std::uint32_t node = 0;
};

/// The index of one of the eight voxels around `at`, an index position in the volume.
std::size_t cornerIndex(const VolumeGeometry& geometry, const Eigen::Vector3d& at, int corner);

/// The lumen of a case on the grid of a volume: f > T of the blended field with a cursor that began
/// in the voxel's own vessel. Voxels farther from every node than twice its radius and a voxel are
/// skipped.
class LumenVoxels {
public:
  /// Both `tree` and `surface` must outlive this object.
  LumenVoxels(const formats::CenterlineTree& tree, const field::BlendedField& surface,
              const VolumeGeometry& geometry, Progress& progress);

  [[nodiscard]] const std::vector<LumenVoxel>& voxels() const { return m_voxels; }  ///< by index
  /// For each voxel of the volume 1 inside and 0 outside.
  [[nodiscard]] const std::vector<std::uint8_t>& inside() const { return m_inside; }

  /// The node of a voxel; empty outside.
  [[nodiscard]] std::optional<std::uint32_t> nodeAt(std::size_t index) const;

  /// Whether `point` (mm, LPS) lies in the lumen of another stretch of the tree than the one to
  /// which the cursor `own` follows it. Lumens narrower than a voxel go undetected.
  [[nodiscard]] bool isInAnother(const Eigen::Vector3d& point, std::uint32_t own) const;

private:
  const field::BlendedField& m_surface;
  VolumeGeometry m_geometry;
  std::vector<LumenVoxel> m_voxels;
  std::vector<std::uint8_t> m_inside;
};

}  // namespace lumen::convert
