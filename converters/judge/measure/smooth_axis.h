// SPDX-License-Identifier: Apache-2.0
// The smoothed curve of a vessel's axis: positions, tangents, curvature and torsion, each with its
// variance (docs/measures.md, section 2).
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

/// Half-width of the smoothing window, in local radii.
inline constexpr double kSmoothingRadii = 6;

/// Centres along a vessel or a path, in order.
struct AxisNodes {
  std::vector<Eigen::Vector3d> position;  ///< mm, LPS
  std::vector<double> radius;             ///< mm
  /// Number of neighbours whose errors are alike, because wall points of one serve the others; at
  /// least 1.
  double correlated = 1;
};

/// A place on the curve. Variances are of errors of the nodes' centres.
struct AxisPlace {
  double along = 0;                           ///< arc length from the first node, mm
  Eigen::Vector3d position, tangent;          ///< mm; unit
  Eigen::Vector3d normal, binormal;           ///< unit; zero on a straight line
  double curvature = 0;                       ///< 1/mm
  double torsion = 0;                         ///< 1/mm; NaN where the curvature is not significant
  double radius = 0;                          ///< of the nodes, interpolated, mm
  double half = 0;                            ///< half-width of the window, mm
  double positionSd = 0, tangentSd = 0;       ///< across the axis in one direction, mm and radians
  double curvatureSd = 0, torsionSd = 0;      ///< 1/mm
  double curvatureBias = 0, torsionBias = 0;  ///< 1/mm: bound of what the smoothing takes away
  /// The window is whole, or nearly: curvature and torsion are defined.
  bool isWhole = false;
};

/// Local fits of a polynomial of fifth degree to the centres, with biweight weights in a window of
/// kSmoothingRadii local radii to either side: cut at the ends, where it grows to the other side.
class SmoothAxis {
public:
  /// Needs at least two nodes at different places.
  explicit SmoothAxis(AxisNodes nodes);

  [[nodiscard]] double length() const { return m_arc.back(); }  ///< mm
  /// Standard deviation of a centre from the curve, mm, in one direction.
  [[nodiscard]] double centreSd() const { return m_sd; }
  /// The place at an arc length in [0, length()], mm.
  [[nodiscard]] AxisPlace at(double along) const;
  /// Arc length at a node, mm.
  [[nodiscard]] double alongOf(std::size_t node) const { return arcAt(m_chord[node]); }
  /// The last node at or before an arc length.
  [[nodiscard]] std::size_t nodeBefore(double along) const;
  [[nodiscard]] std::size_t nodeCount() const { return m_chord.size(); }

private:
  struct Fit;
  [[nodiscard]] Fit fitAt(double chord) const;
  [[nodiscard]] AxisPlace placeAt(double chord) const;
  [[nodiscard]] double halfAt(double chord, double& cut) const;
  [[nodiscard]] double arcAt(double chord) const;
  void findHalves();
  void findNoise();
  void findArcs();

  AxisNodes m_nodes;
  std::vector<double> m_chord;  // along the nodes, mm: the parameter of the fits
  std::vector<double> m_half;   // half-width at each node, mm
  double m_sd = 0;
  std::vector<double> m_grid, m_arc;  // parameters and their arc lengths
};

}  // namespace lumen::convert
