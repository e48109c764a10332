// SPDX-License-Identifier: Apache-2.0
// The wall of a case for measures: rings of the true plane cut, the inscribed sphere, and the spread
// of wall points around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

struct blob_model;

namespace lumen::convert {

/// A place on the axis where the wall is cut, and the plane: its normal is the tangent.
struct CutPlane {
  Eigen::Vector3d centre, tangent;  ///< mm; unit
  std::uint32_t node = 0;           ///< node of a cursor there
  double radius = 0;                ///< expected, mm
};

/// The cut of the wall by a plane, seen from the axis: the first crossing along evenly spread rays.
struct WallRing {
  static constexpr std::size_t kRays = 48;
  std::array<Eigen::Vector3d, kRays> point, normal;  ///< mm; unit, out of the lumen
  std::array<double, kRays> distance{};              ///< from the axis, mm
  std::array<std::uint32_t, kRays> node{};           ///< cursor there
  bool isInside = false;                             ///< the axis is in the lumen
  bool isClosed = false;  ///< every ray meets the wall within four expected radii
};

/// Queries of the blended surface of a case that has models. Any number of threads may query it.
class Wall {
public:
  /// Throws Error(Failed) if libblob refuses the models, and Error(InvalidInput) without any.
  explicit Wall(const formats::Case& source);

  /// The rings of many planes.
  [[nodiscard]] std::vector<WallRing> rings(std::span<const CutPlane> planes) const;
  /// Radius of the greatest sphere around the plane's centre that lies in the lumen, mm: the
  /// distance to the wall, searched from the nearest point of the ring.
  [[nodiscard]] double inscribed(const CutPlane& plane, const WallRing& ring) const;
  /// Signed distances of points from the wall, mm, negative inside; `node` is the cursor of all.
  void distances(std::span<const Eigen::Vector3d> points, std::uint32_t node,
                 std::vector<double>& out) const;

private:
  std::shared_ptr<const blob_model> m_model;
};

}  // namespace lumen::convert
