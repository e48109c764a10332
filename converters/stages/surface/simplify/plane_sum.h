// SPDX-License-Identifier: Apache-2.0
// The quadric of M. Garland and P. Heckbert, *Surface simplification using quadric error metrics*, 1997.
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace lumen::convert {

/// The squared distances from planes, weighted by areas.
class PlaneSum {
public:
  /// The plane of points p with n p + offset = 0.
  void addPlane(const Eigen::Vector3d& n, double offset, double weight) {
    m_xx += weight * n.x() * n.x();
    m_yy += weight * n.y() * n.y();
    m_zz += weight * n.z() * n.z();
    m_xy += weight * n.x() * n.y();
    m_xz += weight * n.x() * n.z();
    m_yz += weight * n.y() * n.z();
    m_x += weight * n.x() * offset;
    m_y += weight * n.y() * offset;
    m_z += weight * n.z() * offset;
    m_d += weight * offset * offset;
    m_area += weight;
  }
  void add(const PlaneSum& o) {
    m_xx += o.m_xx, m_yy += o.m_yy, m_zz += o.m_zz;
    m_xy += o.m_xy, m_xz += o.m_xz, m_yz += o.m_yz;
    m_x += o.m_x, m_y += o.m_y, m_z += o.m_z;
    m_d += o.m_d, m_area += o.m_area;
  }
  /// The mean of the squared distances of a point, relative to the same origin as the planes.
  [[nodiscard]] double meanAt(const Eigen::Vector3d& p) const {
    if (!(m_area > 0)) return 0;
    const double sum = p.x() * (m_xx * p.x() + 2 * (m_xy * p.y() + m_xz * p.z() + m_x)) +
                       p.y() * (m_yy * p.y() + 2 * (m_yz * p.z() + m_y)) +
                       p.z() * (m_zz * p.z() + 2 * m_z) + m_d;
    return std::max(0.0, sum) / m_area;
  }

private:
  double m_xx = 0, m_yy = 0, m_zz = 0, m_xy = 0, m_xz = 0, m_yz = 0, m_x = 0, m_y = 0, m_z = 0;
  double m_d = 0, m_area = 0;
};

}  // namespace lumen::convert
