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

// Figures of a cross-section of the wall (docs/measures.md, section 3).

struct Section {
  double area = 0;       ///< mm^2
  double perimeter = 0;  ///< mm
  /// Distance of two parallel lines that touch the section on either side, mm.
  double least = 0, greatest = 0;
  double circularity = 0;                              ///< 4 pi area / perimeter^2: 1 for a circle
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< mm
  /// Volume and area of the wall for each mm along an axis of this curvature vector (normal times
  /// curvature, 1/mm), by Pappus.
  double volumeRate = 0, wallRate = 0;
};

/// The figures of a closed ring. `bend`: the axis' curvature vector, 1/mm.
Section sectionOf(const CutPlane& plane, const WallRing& ring, const Eigen::Vector3d& bend);

// Uncertainty of the wall: spread of wall points around the surface, and the voxel size
// (docs/measures.md, section 7).

/// Standard deviations that make half of a 95 % interval.
inline constexpr double kHalfInterval = 1.96;

/// Uncertainty of the wall along the vessels of a case.
class WallNoise {
public:
  /// Unknown everywhere for a case without wall points.
  WallNoise(const formats::Case& source, const Wall& wall);

  /// Standard deviation of the radius of a section at a node, mm: that of its mean, and of one place
  /// on its wall. NaN where it is unknown.
  [[nodiscard]] double ofMean(std::uint32_t node) const;
  [[nodiscard]] double ofPlace(std::uint32_t node) const;
  /// The part that all sections share, mm.
  [[nodiscard]] double shared() const { return m_shared; }
  [[nodiscard]] bool isKnown() const { return !m_variance.empty(); }

private:
  std::vector<double> m_variance;  // of wall points around the surface, mm^2
  std::vector<double> m_count;     // independent wall points that a section rests on
  double m_shared = 0;
};

}  // namespace lumen::convert
