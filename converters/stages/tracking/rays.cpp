// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/rays.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace lumen::convert {
namespace {

/// Walls count beyond a twelfth of a ray, as nearer ones are variations within the lumen, and up to
/// 0.8 of it, as farther ones are most likely another vessel's.
constexpr double kLengthOverNearest = 12.0, kFarthestShare = 0.8;

struct Wall {
  double sample = 0;    // position along the ray, in samples
  float strength = -1;  // difference of the two samples around, positive where intensity falls
};

/// The steepest fall of `values`, by central differences up to the first NaN.
Wall steepestFall(std::span<const float> values, float sign) {
  std::size_t best = 0, end = values.size();
  float strongest = 0;
  for (std::size_t i = 1; i + 1 < end; ++i) {
    const float fall = sign * (values[i - 1] - values[i + 1]);
    if (std::isnan(fall)) {
      end = i;
      break;
    }
    if (fall > strongest) {
      strongest = fall;
      best = i;
    }
  }
  // a parabola needs a difference on either side of the best one
  if (best < 2 || best + 2 >= end) return {};
  const double before = sign * (values[best - 2] - values[best]);
  const double after = sign * (values[best] - values[best + 2]);
  const double bend = before - 2.0 * strongest + after;
  const double shift = bend < 0 ? 0.5 * (before - after) / bend : 0.0;
  constexpr double kMostShift = 1.0;  // samples: the maximum is between the best one's neighbours
  return {static_cast<double>(best) + std::clamp(shift, -kMostShift, kMostShift), strongest};
}

}  // namespace

void Candidates::clear() {
  x.clear();
  y.clear();
  z.clear();
  strength.clear();
}

RayCaster::RayCaster(const BsplineVolume& volume, std::vector<Eigen::Vector3d> directions,
                     int samples, bool dark)
    : m_volume(volume),
      m_directions(std::move(directions)),
      m_values(static_cast<std::size_t>(samples)),
      m_sign(dark ? -1.0F : 1.0F) {
  const VolumeGeometry& geometry = volume.geometry();
  for (const auto& direction : m_directions)
    m_indexDirections.emplace_back(
        (geometry.direction.transpose() * direction).cwiseQuotient(geometry.spacing));
}

void RayCaster::cast(const Eigen::Vector3d& centre, double length, Candidates& out) {
  out.clear();
  out.origin = centre;
  const Eigen::Vector3d start = m_volume.geometry().indexFromWorld(centre);
  const double step = length / static_cast<double>(m_values.size() - 1);
  for (std::size_t i = 0; i < m_directions.size(); ++i) {
    m_volume.sampleLine(start, m_indexDirections[i] * step, m_values);
    const Wall wall = steepestFall(m_values, m_sign);
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
