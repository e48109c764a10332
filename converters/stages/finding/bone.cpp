// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/bone.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

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

namespace {

using Eigen::Vector3d;
using Tissues = std::vector<PathTissue>;

constexpr double kLeastExtent = 20;  // radii: connected paths that are bone
constexpr double kBrightest = 0.95;  // quantile of the brightness along vessels

/// Brightness that few places in the middle of vessels exceed, by the paths away from bone.
float brightestVessel(const BrightPaths& bright, std::span<const Tissues> tissues) {
  const auto isAway = [](PathTissue tissue) {
    return tissue == PathTissue::Vessel || tissue == PathTissue::Unknown;
  };
  std::vector<float> values;
  for (std::size_t p = 0; p < tissues.size(); ++p)
    if (std::all_of(tissues[p].begin(), tissues[p].end(), isAway))
      for (const std::uint32_t i : bright.paths[p].voxels)
        values.push_back(bright.brightness(bright.set.index(i)));
  return values.empty() ? std::numeric_limits<float>::infinity()
                        : lowerQuantile(values, kBrightest);
}

/// Decides on the edges of bone: a whole path is bone or a vessel beside it.
void decide(const BrightPaths& bright, const VesselPath& path, float brightest, Tissues& tissue) {
  std::ptrdiff_t bone = 0, known = 0;
  for (std::size_t k = 0; k < tissue.size(); ++k) {
    known += tissue[k] == PathTissue::Unknown ? 0 : 1;
    const bool isEdge = tissue[k] == PathTissue::BesideBone &&
                        bright.brightness(bright.set.index(path.voxels[k])) > brightest;
    bone += isEdge || tissue[k] == PathTissue::Bone ? 1 : 0;
  }
  std::replace(tissue.begin(), tissue.end(), PathTissue::BesideBone, PathTissue::Vessel);
  if (2 * bone > known)
    std::replace(tissue.begin(), tissue.end(), PathTissue::Vessel, PathTissue::Bone);
}

/// Divides a set among vessels and bone.
class Division {
public:
  Division(const VoxelSet& set, std::span<const float> depths, const Progress& progress)
      : m_set(set),
        m_depths(depths),
        m_progress(progress),
        m_owner(set.size(), PathTissue::Unknown) {}

  /// Gives the balls around the voxels of a path to an owner, as far as they are free.
  void takeBalls(std::uint32_t i, PathTissue owner) {
    m_set.eachWithin(i, static_cast<double>(m_depths[i]), [&](std::uint32_t j) {
      if (m_owner[j] != PathTissue::Unknown) return;
      m_owner[j] = owner;
      m_taken.push_back(j);
    });
  }

  /// Gives all other voxels to the owner from whom the fewest steps lead to them.
  void takeRest() {
    for (std::size_t k = 0; k < m_taken.size(); ++k) {
      m_progress.check();
      m_set.eachBeside(m_taken[k], [&](std::uint32_t j, const Vector3d&) {
        if (m_owner[j] != PathTissue::Unknown) return;
        m_owner[j] = m_owner[m_taken[k]];
        m_taken.push_back(j);
      });
    }
  }

  /// The bone that touches `known` bone, or whose paths, those voxels for which `isPath`, are long
  /// for their width.
  [[nodiscard]] std::vector<bool> largeBone(const std::vector<bool>& isPath,
                                            std::span<const std::size_t> known) const {
    std::vector<bool> isSeen(m_set.size(), false), isBone;
    for (std::uint32_t first = 0; first < m_set.size(); ++first) {
      if (isSeen[first] || m_owner[first] != PathTissue::Bone) continue;
      std::vector<std::uint32_t> part(1, first);
      isSeen[first] = true;
      double length = 0, width = 0;
      std::size_t count = 0;
      bool touches = false;
      for (std::size_t k = 0; k < part.size(); ++k) {
        m_progress.check();
        touches = touches || isBeside(known, part[k]);
        if (isPath[part[k]]) {
          length += m_set.geometry().voxelSize();
          width += static_cast<double>(m_depths[part[k]]);
          ++count;
        }
        m_set.eachBeside(part[k], [&](std::uint32_t j, const Vector3d&) {
          if (isSeen[j] || m_owner[j] != PathTissue::Bone) return;
          isSeen[j] = true;
          part.push_back(j);
        });
      }
      if (!touches && length * static_cast<double>(count) < kLeastExtent * width) continue;
      isBone.resize(m_set.size(), false);
      for (const std::uint32_t i : part) isBone[i] = true;
    }
    return isBone;
  }

private:
  [[nodiscard]] bool isBeside(std::span<const std::size_t> known, std::uint32_t i) const {
    const CellBox cells = m_set.geometry().cells();
    bool is = false;
    cells.forEachNeighbour(m_set.cell(i), [&](const Cell& cell) {
      is = is || std::binary_search(known.begin(), known.end(), cells.index(cell));
    });
    return is;
  }

  const VoxelSet& m_set;
  std::span<const float> m_depths;
  const Progress& m_progress;
  std::vector<PathTissue> m_owner;
  std::vector<std::uint32_t> m_taken;
};

}  // namespace

std::vector<bool> boneVoxels(const BrightPaths& bright, std::span<const std::size_t> bone,
                             const Progress& progress) {
  std::vector<Tissues> tissues(bright.paths.size());
  tbb::parallel_for(std::size_t{0}, tissues.size(), [&](std::size_t p) {
    progress.check();
    tissues[p] = tissueAlong(bright.set, bright.depths, bone, bright.paths[p].voxels);
  });
  const float brightest = brightestVessel(bright, tissues);
  for (std::size_t p = 0; p < tissues.size(); ++p)
    decide(bright, bright.paths[p], brightest, tissues[p]);
  std::vector<bool> isPath(bright.set.size(), false);
  Division division(bright.set, bright.depths, progress);
  for (const PathTissue wanted : {PathTissue::Vessel, PathTissue::Bone})
    for (std::size_t p = 0; p < tissues.size(); ++p)
      for (std::size_t k = 0; k < tissues[p].size(); ++k) {
        if (tissues[p][k] != wanted) continue;
        division.takeBalls(bright.paths[p].voxels[k], wanted);
        if (wanted == PathTissue::Bone) isPath[bright.paths[p].voxels[k]] = true;
      }
  if (std::find(isPath.begin(), isPath.end(), true) == isPath.end()) return {};
  division.takeRest();
  return division.largeBone(isPath, bone);
}

}  // namespace lumen::convert
