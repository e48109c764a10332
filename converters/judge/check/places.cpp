// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/places.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/judge/check/skeleton_paths.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {
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
