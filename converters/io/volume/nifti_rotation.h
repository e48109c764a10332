// SPDX-License-Identifier: Apache-2.0
// Rotations as NIfTI-1's qform states them, in its own RAS. All roundings are those of the NIfTI
// library (niftiio), so that headers are equal to the last bit.
#pragma once

#include <array>

#include <Eigen/Core>

namespace lumen::convert {

/// A rotation (b, c, d of a unit quaternion), and whether the third axis is flipped: then the
/// handedness is negative.
struct NiftiRotation {
  std::array<float, 3> quaternion{};
  float handedness = 1;
};

/// The axes of the rotation, as columns of the lengths `steps`.
Eigen::Matrix3f niftiAxes(const NiftiRotation& rotation, const std::array<float, 3>& steps);

/// The rotation with these columns, which are orthogonal unit vectors but for roundings.
NiftiRotation niftiRotation(const Eigen::Matrix3f& axes);

/// The nearest matrix whose columns are orthogonal unit vectors.
Eigen::Matrix3f orthogonalAxes(const Eigen::Matrix3f& axes);

}  // namespace lumen::convert
