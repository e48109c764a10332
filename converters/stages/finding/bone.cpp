// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/bone.h"

#include <algorithm>
#include <limits>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/stages/finding/path_tissue.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Tissues = std::vector<PathTissue>;

constexpr double kLeastExtent = 20;  // radii: connected paths that are bone
constexpr double kBrightest = 0.95;  // quantile of the brightness along vessels
constexpr std::size_t kVoxelsToCheck = 1 << 14;

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
      if (k % kVoxelsToCheck == 0) m_progress.check();
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
        if (k % kVoxelsToCheck == 0) m_progress.check();
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
