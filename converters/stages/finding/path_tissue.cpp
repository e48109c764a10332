// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/path_tissue.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kDiameters = 16;      // of the ring across a path, evenly turned
constexpr double kRingRadii = 2.5;  // radius of that ring, in those of the vessel
constexpr double kWindowRadii = 4;  // path before and behind a place that is judged with it

/// Least share of the diameters of the ring that end in bright voxels on both sides: half of the
/// share that a plate has whose half thickness is the radius. So much of the ring beside bone, too.
const double kLeastShare = std::asin(1 / kRingRadii) / std::numbers::pi;

/// Measures on the rings across a path.
class Rings {
public:
  Rings(const VoxelSet& set, std::span<const float> depths, std::span<const std::size_t> bone,
        std::span<const std::uint32_t> path)
      : m_set(set),
        m_bone(bone),
        m_path(path),
        m_radii(path.size()),
        m_shares(path.size()),
        m_isBesideBone(path.size(), false) {
    for (std::size_t k = 0; k < path.size(); ++k)
      m_radii[k] = static_cast<double>(depths[path[k]]) + 0.5 * step();
    for (std::size_t k = 0; k < path.size(); ++k) measure(k);
  }

  /// The first place that lies outside of the vessel at which the path begins.
  [[nodiscard]] std::size_t firstOutside() const {
    std::size_t k = 0;
    while (k < m_path.size() && (at(k) - at(0)).norm() < 1.5 * m_radii[0]) ++k;
    return k;
  }

  [[nodiscard]] PathTissue tissue(std::size_t k) const {
    if (usualShare(k) >= kLeastShare) return PathTissue::Bone;
    return m_isBesideBone[k] ? PathTissue::BesideBone : PathTissue::Vessel;
  }

private:
  enum class Place : std::uint8_t { BeyondVolume, Background, InSet, Bone };

  [[nodiscard]] double step() const { return m_set.geometry().voxelSize(); }
  [[nodiscard]] Vector3d at(std::size_t k) const { return m_set.position(m_path[k]); }

  [[nodiscard]] Vector3d directionAt(std::size_t k) const {
    std::size_t a = k, b = k;
    while (a > 0 && (at(a) - at(k)).norm() < 2 * m_radii[k]) --a;
    while (b + 1 < m_path.size() && (at(b) - at(k)).norm() < 2 * m_radii[k]) ++b;
    return (at(b) - at(a)).normalized();
  }

  [[nodiscard]] Place placeAt(const Vector3d& position) const {
    const VolumeGeometry& geometry = m_set.geometry();
    const auto cell = geometry.cells().nearest(geometry.indexFromWorld(position));
    if (!cell) return Place::BeyondVolume;
    const std::size_t index = geometry.cells().index(*cell);
    if (m_set.find(index) != VoxelSet::kNone) return Place::InSet;
    return std::binary_search(m_bone.begin(), m_bone.end(), index) ? Place::Bone
                                                                   : Place::Background;
  }

  /// Whether the set ends at bone, within the ring, on the way out from a place.
  [[nodiscard]] bool leadsToBone(std::size_t k, const Vector3d& side) const {
    for (double away = 0; away <= kRingRadii * m_radii[k]; away += 0.5 * step()) {
      const Place place = placeAt(at(k) + away * side);
      if (place != Place::InSet) return place == Place::Bone;
    }
    return false;
  }

  void measure(std::size_t k) {
    const Vector3d w = directionAt(k), u = w.unitOrthogonal(), v = w.cross(u);
    int both = 0, within = 0, beside = 0;
    for (int n = 0; n < kDiameters; ++n) {
      const double angle = std::numbers::pi * n / kDiameters;
      const Vector3d side = std::cos(angle) * u + std::sin(angle) * v;
      const Place a = placeAt(at(k) + kRingRadii * m_radii[k] * side);
      const Place b = placeAt(at(k) - kRingRadii * m_radii[k] * side);
      within += a != Place::BeyondVolume && b != Place::BeyondVolume ? 1 : 0;
      both += a == Place::InSet && b == Place::InSet ? 1 : 0;
      if (!m_bone.empty())
        beside += (leadsToBone(k, side) ? 1 : 0) + (leadsToBone(k, -side) ? 1 : 0);
    }
    m_shares[k] = static_cast<double>(both) / std::max(1, within);
    m_isBesideBone[k] = beside >= kLeastShare * 2 * kDiameters;
  }

  /// The median share around a place of the path, over the stretch that it is judged with.
  [[nodiscard]] double usualShare(std::size_t k) const {
    const auto reach = static_cast<std::size_t>(std::ceil(kWindowRadii * m_radii[k] / step()));
    const std::size_t first = k - std::min(k, reach), end = std::min(m_path.size(), k + reach + 1);
    std::vector<double> some(m_shares.begin() + static_cast<std::ptrdiff_t>(first),
                             m_shares.begin() + static_cast<std::ptrdiff_t>(end));
    return upperMedian(some);
  }

  const VoxelSet& m_set;
  std::span<const std::size_t> m_bone;
  std::span<const std::uint32_t> m_path;
  std::vector<double> m_radii, m_shares;  ///< mm; of diameters that end in the set on both sides
  std::vector<bool> m_isBesideBone;
};

}  // namespace

std::vector<PathTissue> tissueAlong(const VoxelSet& set, std::span<const float> depths,
                                    std::span<const std::size_t> bone,
                                    std::span<const std::uint32_t> path) {
  std::vector<PathTissue> tissue(path.size(), PathTissue::Unknown);
  if (path.size() < 2) return tissue;
  const Rings rings(set, depths, bone, path);
  for (std::size_t k = rings.firstOutside(); k < path.size(); ++k) tissue[k] = rings.tissue(k);
  return tissue;
}

}  // namespace lumen::convert
