// SPDX-License-Identifier: Apache-2.0
// The implicit function of one node, laid out for evaluation along the rows of a grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// f and its gradient at a point.
struct FieldSample {
  double f = 0;                                        ///< mm
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< dimensionless
};

/// f(X) = sum_j w_j phi(|X - C_j|^2 / w_j^2) over one node's blobs, as a structure of arrays. It
/// calls nothing of the C library's mathematics but square roots, so that every machine gets the
/// same bits.
class NodeField {
public:
  NodeField(const formats::BlobbyModels& models, std::uint32_t node);

  [[nodiscard]] double value(const Eigen::Vector3d& point) const;
  [[nodiscard]] FieldSample sample(const Eigen::Vector3d& point) const;

  /// f at (cell * (first + i), y, z) for i = 0 .. out.size() - 1, mm. SIMD by run-time dispatch.
  void sampleRow(int first, double cell, double y, double z, std::span<double> out) const;
  /// The scalar reference for sampleRow: the same bits.
  void sampleRowReference(int first, double cell, double y, double z, std::span<double> out) const;

  /// The share t in (0, 1) of the distance from a to b at which f = T; f(a) = fa and f(b) = fb lie
  /// on either side of T. Newton's method within the bracket, on the level transform of f, which is
  /// nearly straight across a wall.
  [[nodiscard]] double crossing(const Eigen::Vector3d& a, double fa, const Eigen::Vector3d& b,
                                double fb) const;

  /// One range of lattice positions, empty if first > last.
  struct Range {
    int first = 0, last = -1;
  };
  /// A range of the row at (y, z) that holds every lattice position (cell * i, y, z) where f > T,
  /// and every one that is next to such a position of this row or of the eight rows around it.
  [[nodiscard]] Range rangeNearInside(double cell, double y, double z) const;

  /// The box that holds the points where f > T.
  [[nodiscard]] const Eigen::Vector3d& low() const { return m_low; }
  [[nodiscard]] const Eigen::Vector3d& high() const { return m_high; }
  [[nodiscard]] bool empty() const { return m_width.empty(); }
  [[nodiscard]] double isoLevel() const { return m_level; }

private:
  formats::Kernel m_kernel;
  double m_parameter, m_level;
  std::vector<double> m_x, m_y, m_z, m_width;
  std::vector<double> m_scale;  ///< factor of |X - C|^2: 1/w^2 and the kernel's parameter
  std::vector<double> m_reach;  ///< where f > T, some blob is nearer than its reach, mm
  Eigen::Vector3d m_low, m_high;
};

}  // namespace lumen::convert
