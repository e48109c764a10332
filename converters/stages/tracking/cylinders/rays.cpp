// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/rays.h"

#include <algorithm>
#include <span>
#include <utility>

namespace lumen::convert {
namespace {

/// Walls count beyond a twelfth of a ray, as nearer ones are variations within the lumen, and up to
/// 0.8 of it, as farther ones are most likely another vessel's.
constexpr double kLengthOverNearest = 12.0, kFarthestShare = 0.8;

}  // namespace

void Candidates::clear() {
  x.clear();
  y.clear();
  z.clear();
  strength.clear();
}

RayCaster::RayCaster(const BsplineVolume& volume, std::vector<Eigen::Vector3d> directions,
                     int samples, bool dark, double mostPerEdge)
    : m_volume(volume),
      m_directions(std::move(directions)),
      m_values(static_cast<std::size_t>(samples)),
      m_sign(dark ? -1.0F : 1.0F) {
  const VolumeGeometry& geometry = volume.geometry();
  m_mostPerEdge = mostPerEdge;
  for (const auto& direction : m_directions)
    m_indexDirections.emplace_back(
        (geometry.direction.transpose() * direction).cwiseQuotient(geometry.spacing));
}

void RayCaster::cast(const Eigen::Vector3d& centre, double length, Candidates& out) {
  out.clear();
  out.origin = centre;
  const Eigen::Vector3d start = m_volume.geometry().indexFromWorld(centre);
  const double edges = length / m_volume.geometry().spacing.minCoeff();
  const double most = m_mostPerEdge * std::max(1.0, edges);
  const auto count = std::min<double>(most, static_cast<double>(m_values.size()));
  const std::span values = std::span(m_values).first(static_cast<std::size_t>(count));
  const double step = length / static_cast<double>(values.size() - 1);
  for (std::size_t i = 0; i < m_directions.size(); ++i) {
    m_volume.sampleLine(start, m_indexDirections[i] * step, values);
    const SteepestFall wall = steepestFall(values, m_sign);
    const double t = wall.sample * step;
    if (wall.strength <= 0 || t < length / kLengthOverNearest || t > kFarthestShare * length)
      continue;
    const Eigen::Vector3f offset = (t * m_directions[i]).cast<float>();
    out.x.push_back(offset.x());
    out.y.push_back(offset.y());
    out.z.push_back(offset.z());
    out.strength.push_back(wall.strength / static_cast<float>(2.0 * step));
  }
}

}  // namespace lumen::convert
