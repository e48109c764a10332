// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/places.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/judge/check/skeleton_paths.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {

namespace {

constexpr double kCorner = 1.5;               // radii of a ball: it does not fill a right angle
constexpr std::size_t kCheckEvery = 1 << 14;  // voxels: well below 100 ms

/// The node nearest to a place, by cells of several voxels, as levels vary slowly.
class NearestNode {
public:
  NearestNode(const VolumeGeometry& geometry, const formats::CenterlineTree& tree)
      : m_geometry(geometry), m_tree(tree) {
    const Cell last = geometry.cells().high();
    m_blocks = CellBox::between(Cell::Zero(), last / kEdge);
    m_node.resize(m_blocks.count(), VoxelSet::kNone);
  }

  std::uint32_t of(const Cell& cell) {
    const Cell block = cell / kEdge;
    std::uint32_t& node = m_node[m_blocks.index(block)];
    if (node == VoxelSet::kNone) node = search(block);
    return node;
  }

private:
  static constexpr int kEdge = 8;  // voxels

  [[nodiscard]] std::uint32_t search(const Cell& block) const {
    const Eigen::Vector3d middle = (block.cast<double>().array() + 0.5) * kEdge - 0.5;
    const Eigen::Vector3d at = m_geometry.worldFromIndex(middle);
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t node = 0;
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n) {
      const double away =
          (toEigen(m_tree.centre[n]) - at).norm() - static_cast<double>(m_tree.radius[n]);
      if (away < best) {
        best = away;
        node = n;
      }
    }
    return node;
  }

  const VolumeGeometry& m_geometry;
  const formats::CenterlineTree& m_tree;
  CellBox m_blocks;
  std::vector<std::uint32_t> m_node;
};

struct Reached {
  std::size_t index;
  std::uint32_t node;
};

/// The bright voxels outside, nearest first, of which the first `rim` touch the lumen; `bright` is
/// 1 inside and becomes 1 there.
template <class Value>
std::vector<Reached> grow(const LumenVoxels& lumen, const Levels& levels, NearestNode& nearest,
                          const Value& value, std::vector<std::uint8_t>& bright, std::size_t& rim,
                          const Progress& progress) {
  std::vector<Reached> reached;
  const CellBox cells = levels.volume.geometry.cells();
  const auto from = [&](std::size_t index, std::uint32_t node) {
    cells.forEachNeighbour(cells.cell(index), [&](const Cell& cell) {
      const std::size_t next = cells.index(cell);
      if (bright[next] != 0 || !levels.volume.geometry.isImage(next) ||
          (!levels.isNoVessel.empty() && levels.isNoVessel[next]) ||
          !(value(next) > levels.node[node].half) ||
          !(value(next) > levels.node[nearest.of(cell)].faint))
        return;
      bright[next] = 1;
      reached.push_back({next, node});
    });
  };
  for (const LumenVoxel& voxel : lumen.voxels()) from(voxel.index, voxel.node);
  rim = reached.size();
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (i % kCheckEvery == 0) progress.check();
    const Reached here = reached[i];
    from(here.index, here.node);
  }
  return reached;
}

/// Spreads from the voxels of `seeds` to the neighbours that take(j, offset) accepts; the offset
/// from the seed is in mm along the axes of the grid.
template <class Take>
void flood(const VoxelSet& voxels, const std::vector<std::uint32_t>& seeds,
           const Progress& progress, Take&& take) {
  std::deque<std::pair<std::uint32_t, Eigen::Vector3f>> queue;
  for (const std::uint32_t seed : seeds) queue.emplace_back(seed, Eigen::Vector3f::Zero());
  for (; !queue.empty(); queue.pop_front()) {
    const auto [i, here] = queue.front();
    if (i % kCheckEvery == 0) progress.check();
    voxels.eachBeside(i, [&, from = here](std::uint32_t j, const Eigen::Vector3d& step) {
      const Eigen::Vector3f there = from + step.cast<float>();
      if (take(j, there)) queue.emplace_back(j, there);
    });
  }
}

/// Marks (1) voxels within kCorner of the centres of balls of radius `widest` inside the region,
/// and those connected with the lumen only through them.
std::vector<std::uint8_t> wideParts(const BrightRegion& region, double widest,
                                    const Progress& progress) {
  const VoxelSet& voxels = region.voxels;
  std::vector<std::uint8_t> wide(voxels.size(), 0);
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t i = 0; i < voxels.size(); ++i)
    if (static_cast<double>(region.depth[i]) > widest) {
      seeds.push_back(i);
      wide[i] = 1;
    }
  if (seeds.empty()) return wide;
  const auto reach = static_cast<float>(kCorner * widest + voxels.geometry().voxelSize());
  flood(voxels, seeds, progress, [&](std::uint32_t j, const Eigen::Vector3f& offset) {
    if (wide[j] != 0 || offset.norm() > reach) return false;
    wide[j] = 1;
    return true;
  });
  std::vector<std::uint8_t> apart(voxels.size(), 1);
  seeds.clear();
  for (std::size_t i = 0; i < region.rim; ++i)
    if (wide[region.order[i]] == 0) {
      seeds.push_back(region.order[i]);
      apart[region.order[i]] = 0;
    }
  flood(voxels, seeds, progress, [&](std::uint32_t j, const Eigen::Vector3f&) {
    if (wide[j] != 0 || apart[j] == 0) return false;
    apart[j] = 0;
    return true;
  });
  return apart;
}

}  // namespace

BrightRegion growBrightRegion(const LumenVoxels& lumen, const Levels& levels,
                              const formats::CenterlineTree& tree, double widest,
                              const Progress& progress) {
  std::vector<std::uint8_t> bright = lumen.inside();
  NearestNode nearest(levels.volume.geometry, tree);
  std::vector<Reached> reached;
  std::size_t rim = 0;
  withVoxels(levels, [&](const auto& value) {
    reached = grow(lumen, levels, nearest, value, bright, rim, progress);
  });
  std::vector<std::size_t> indices;
  indices.reserve(reached.size());
  for (const Reached& voxel : reached) indices.push_back(voxel.index);
  std::sort(indices.begin(), indices.end());
  BrightRegion region{VoxelSet(levels.volume.geometry, std::move(indices)), {}, {}, rim, {}, {}};
  region.node.resize(reached.size());
  for (const Reached& voxel : reached) {
    region.order.push_back(region.voxels.find(voxel.index));
    region.node[region.order.back()] = voxel.node;
  }
  progress.check();
  region.depth = measureDepths(
      region.voxels, [&](std::size_t i) { return bright[i] != 0; }, progress);
  progress.check();
  region.wide = wideParts(region, widest, progress);
  return region;
}

namespace {

using Eigen::Vector3d;

/// Radii: clicks nearer to one another give no direction of a vessel.
constexpr double kLeastApart = 4;

constexpr double kDarkDepth = 1, kBrightAway = 2;         // voxels: the wall's own blur and error
constexpr std::size_t kLeastDark = 4, kLeastBright = 20;  // voxels: fewer are noise
constexpr double kLeastLength = 4;                        // voxels
constexpr double kTooWide = 1.5;  // times the widest vessel: the root is seldom wider

/// The connected groups of the voxels i with free[i] != 0, which are used up.
Regions findRegions(const VoxelSet& set, std::span<const float> depth,
                    std::span<const std::uint32_t> node, std::vector<std::uint8_t>& free,
                    std::size_t least) {
  const double each = set.geometry().spacing.prod();
  Regions result;
  std::vector<std::uint32_t> group;
  for (std::uint32_t seed = 0; seed < set.size(); ++seed) {
    if (free[seed] == 0) continue;
    group.assign(1, seed);
    free[seed] = 0;
    std::uint32_t deepest = seed;
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (depth[group[i]] > depth[deepest]) deepest = group[i];
      set.eachBeside(group[i], [&](std::uint32_t j, const Vector3d&) {
        if (free[j] != 0) group.push_back(j);
        free[j] = 0;
      });
    }
    const double volume = static_cast<double>(group.size()) * each;
    result.volume += volume;
    if (group.size() >= least)
      result.regions.push_back({set.position(deepest), node[deepest], group.size(), volume,
                                static_cast<double>(depth[deepest])});
  }
  std::stable_sort(result.regions.begin(), result.regions.end(),
                   [](const Region& a, const Region& b) { return a.volume > b.volume; });
  return result;
}

/// 1 for each voxel of the set that is not wide and has no voxel inside within kBrightAway.
std::vector<std::uint8_t> awayFromLumen(const BrightRegion& region, const LumenVoxels& lumen) {
  const VolumeGeometry& geometry = region.voxels.geometry();
  const double limit = kBrightAway * geometry.voxelSize() * (1 + 1e-9);
  const Cell reach = (limit * geometry.spacing.cwiseInverse()).array().floor().cast<int>();
  std::vector<Cell> offsets;
  CellBox::between(-reach, reach).forEach([&](const Cell& offset) {
    if (geometry.spacing.cwiseProduct(offset.cast<double>()).norm() <= limit)
      offsets.push_back(offset);
  });
  const auto isInside = [&](const Cell& cell) {
    return geometry.contains(cell) && lumen.inside()[geometry.index(cell)] != 0;
  };
  std::vector<std::uint8_t> away(region.voxels.size(), 0);
  for (std::uint32_t i = 0; i < region.voxels.size(); ++i) {
    if (region.wide[i] != 0) continue;
    const Cell at = region.voxels.cell(i);
    away[i] = std::none_of(offsets.begin(), offsets.end(),
                           [&](const Cell& offset) { return isInside(at + offset); });
  }
  return away;
}

double greatestRadius(const formats::CenterlineTree& tree) {
  float widest = 0;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.branches[tree.branch[n]].kind == formats::BranchKind::Vessel)
      widest = std::max(widest, tree.radius[n]);
  if (widest == 0) widest = *std::max_element(tree.radius.begin(), tree.radius.end());
  return static_cast<double>(widest);
}

MissingVessel makeMissingVessel(const SkeletonPath& path, const BrightRegion& region) {
  MissingVessel vessel;
  for (const std::uint32_t i : path.voxels)
    vessel.path.push_back({region.voxels.position(i), region.node[i]});
  vessel.voxels = path.covered;
  vessel.volume = static_cast<double>(path.covered) * region.voxels.geometry().spacing.prod();
  vessel.length = path.length;
  vessel.radius = path.radius;
  return vessel;
}

}  // namespace

Regions darkInside(const LumenVoxels& lumen, const Levels& levels, const Progress& progress) {
  const VolumeGeometry& geometry = levels.volume.geometry;
  std::vector<std::size_t> all;
  for (const LumenVoxel& voxel : lumen.voxels()) all.push_back(voxel.index);
  const VoxelSet inside(geometry, std::move(all));
  const std::vector<float> depth = measureDepths(
      inside, [&](std::size_t i) { return lumen.inside()[i] != 0; }, progress);
  std::vector<std::size_t> dark;
  std::vector<std::uint32_t> node;
  withVoxels(levels, [&](const auto& value) {
    for (std::uint32_t i = 0; i < inside.size(); ++i) {
      const LumenVoxel& voxel = lumen.voxels()[i];
      if (!(static_cast<double>(depth[i]) > kDarkDepth * geometry.voxelSize()) ||
          !(value(voxel.index) < levels.node[voxel.node].half))
        continue;
      dark.push_back(voxel.index);
      node.push_back(voxel.node);
    }
  });
  progress.check();
  const VoxelSet set(geometry, std::move(dark));
  std::vector<std::uint8_t> free(set.size(), 1);
  const auto depths = measureDepths(
      set, [&](std::size_t i) { return set.find(i) != VoxelSet::kNone; }, progress);
  return findRegions(set, depths, node, free, kLeastDark);
}

Missing brightOutside(const LumenVoxels& lumen, const Levels& levels,
                      const formats::CenterlineTree& tree, const Progress& progress) {
  const BrightRegion region =
      growBrightRegion(lumen, levels, tree, kTooWide * greatestRadius(tree), progress);
  const VoxelSet& voxels = region.voxels;
  Missing result;
  std::vector<std::uint8_t> wide = region.wide;
  result.wide = findRegions(voxels, region.depth, region.node, wide, kLeastBright);
  std::vector<std::uint8_t> free = awayFromLumen(region, lumen);
  progress.check();
  SkeletonPaths skeleton(voxels, region.depth, free);
  std::vector<SkeletonPath> paths;
  std::size_t count = 0;
  for (const std::uint32_t i : region.order)
    if (free[i] != 0)
      count += skeleton.split(i, kLeastLength * voxels.geometry().voxelSize(), kLeastBright,
                              progress, paths);
  result.volume = static_cast<double>(count) * voxels.geometry().spacing.prod();
  for (const SkeletonPath& path : paths) result.vessels.push_back(makeMissingVessel(path, region));
  std::stable_sort(result.vessels.begin(), result.vessels.end(),
                   [](const MissingVessel& a, const MissingVessel& b) {
                     return std::tie(a.length, a.volume) > std::tie(b.length, b.volume);
                   });
  return result;
}

Clicks clicksOn(const MissingVessel& vessel) {
  const std::size_t middle = vessel.path.size() / 2, on = (middle + vessel.path.size()) / 2;
  const Vector3d first = vessel.path[middle].position;
  Clicks clicks{{first}, vessel.radius, vessel.path.front().node};
  if (on < vessel.path.size() &&
      (vessel.path[on].position - first).norm() > kLeastApart * vessel.radius)
    clicks.points.push_back(vessel.path[on].position);
  return clicks;
}

double shownLength(const formats::CenterlineTree& tree, const LumenVoxels& lumen,
                   const Levels& levels) {
  const VolumeGeometry& geometry = levels.volume.geometry;
  // Brightness at an edge's middle: the brightest of the eight voxels around it, as thin vessels
  // have no more
  const auto isShown = [&](const Vector3d& middle, std::uint32_t n, const auto& value) {
    const Vector3d at = geometry.indexFromWorld(middle);
    if (!geometry.containsIndex(at)) return false;
    bool bright = false, own = false, claimed = false;
    for (int corner = 0; corner < 8; ++corner) {
      const std::size_t index = cornerIndex(geometry, at, corner);
      bright = bright || value(index) > levels.node[n].half;
      const auto claimant = lumen.nodeAt(index);
      claimed = claimed || claimant.has_value();
      own = own || (claimant && tree.branch[*claimant] == tree.branch[n]);
    }
    return bright && (own || !claimed);
  };
  double length = 0;
  withVoxels(levels, [&](const auto& value) {
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
      if (tree.parent[n] < 0 || tree.branches[tree.branch[n]].kind != formats::BranchKind::Vessel)
        continue;
      const Vector3d from = toEigen(tree.centre[static_cast<std::size_t>(tree.parent[n])]);
      const Vector3d to = toEigen(tree.centre[n]);
      if (isShown(0.5 * (from + to), n, value)) length += (to - from).norm();
    }
  });
  return length;
}

}  // namespace lumen::convert
