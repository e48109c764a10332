// SPDX-License-Identifier: Apache-2.0
// Four triangles at once: hits of a ray, nearest points.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "converters/geometry/box_tree.h"

namespace lumen::convert {

/// The point of the triangle a, b, c that is nearest to `p`.
Eigen::Vector3d nearestPointOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// The corners of up to four triangles as a structure of arrays; the others are points in the
/// origin, which no ray meets.
struct TriangleBlock {
  static constexpr std::size_t kWidth = BoxTree<float>::kLeafItems;
  using Lanes = std::array<double, kWidth>;
  void set(std::size_t k, const std::array<Eigen::Vector3d, 3>& triangle);
  std::array<std::array<Lanes, 3>, 3> corner{};  ///< by corner, axis, then triangle
};

/// Hits of a ray on the triangles of a block; a distance below 0 or that is not a number is none.
struct BlockHits {
  TriangleBlock::Lanes distance;  ///< from the ray's origin
  TriangleBlock::Lanes det;       ///< below 0: the ray comes from behind
};
void meetBlock(const TriangleBlock& block, const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction, BlockHits& out);

/// The points of the triangles of a block that are nearest to a point, and their squared distances:
/// those of nearestPointOnTriangle(), to the last bit.
struct BlockPoints {
  TriangleBlock::Lanes squared;
  std::array<TriangleBlock::Lanes, 3> at;  ///< by axis
};
void nearestInBlock(const TriangleBlock& block, const Eigen::Vector3d& point, BlockPoints& out);

}  // namespace lumen::convert
