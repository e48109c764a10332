// SPDX-License-Identifier: Apache-2.0
// An ellipse about an axis through the wall points of a node (docs/method.md, section 1.11).
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

/// Unknowns of a WallEllipse.
inline constexpr int kEllipseUnknowns = 7;
using EllipseUnknowns = Eigen::Matrix<double, kEllipseUnknowns, 1>;

/// Sectors around an axis, and the number of them that must have wall points for an ellipse.
inline constexpr std::size_t kSectors = 12, kLeastSectors = 8;

/// A wall point about an axis.
struct WallPlace {
  Eigen::Vector3d position;                       ///< mm, LPS
  double angle = 0, distance = 0;                 ///< around the axis, radians; from it, mm
  EllipseUnknowns row = EllipseUnknowns::Zero();  ///< factors of the ellipse's unknowns
};

/// An ellipse about an axis, which widens or narrows along it: the inverse square of the distance
/// of its wall is linear in the sine and cosine of twice the angle; those of the angle itself move
/// it, to first order; the place along the axis and its square are a taper and a throat. Lengths:
/// mm.
struct WallEllipse {
  EllipseUnknowns curve = EllipseUnknowns::Zero();

  /// Distance of the wall from the axis in the direction of a place; infinite if there is none.
  [[nodiscard]] double wallAt(const WallPlace& place) const;
  /// True if it is an ellipse, and not so long that it is two vessels.
  [[nodiscard]] bool isValid() const;
  /// The radius of a disc of the same area.
  [[nodiscard]] double radius() const;
  /// The step from the axis to its middle, along the two vectors of planeBasis(axis).
  [[nodiscard]] Eigen::Vector2d middle() const;
};

/// Sets the angles and distances of places about an axis through `centre` along `axis` (unit).
void measureAbout(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis,
                  std::vector<WallPlace>& places);

/// The ellipse through most of the places, by least squares of the distance to its wall with
/// Tukey's weights, from a circle of that radius on. It may be no valid one.
WallEllipse fitEllipse(const std::vector<WallPlace>& places, double radius);

/// The number of sectors that hold a place.
std::size_t sectorsWith(const std::vector<WallPlace>& places);

}  // namespace lumen::convert
