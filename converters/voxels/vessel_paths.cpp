// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/vessel_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

constexpr std::uint32_t kNone = VesselPath::kNone;

/// Depths are in voxels; a quarter more keeps steps along the wall possible.
SkeletonPrice priceIn(const VolumeGeometry& geometry) {
  return {4, static_cast<float>(geometry.voxelSize()), 0.25F};
}

// Share of the depth: balls closer to each other cover about the same.
constexpr float kBallStep = 0.25F;
constexpr double kLeastVoxels = 3;
// Depths from a tip: the stretch that shows the width of its vessel.
constexpr double kTip = 4;
// Multiple of the depth in the neck: a path that gets deeper behind it leads into a sac.
constexpr double kSacDepthRatio = 1.25;
// Path along the tree over the distance across: beyond this ratio a tip has closed a loop.
constexpr double kLoop = 4;

}  // namespace

VesselPaths::VesselPaths(const VoxelSet& set, std::span<const float> depths, const IsOpen& isOpen,
                         const Progress& progress, double leastOfParent)
    : m_set(set),
      m_isOpen(isOpen),
      m_skeleton(set, depths, priceIn(set.geometry())),
      m_steps(kMostSteps * set.size(), kNoStep),
      m_leastOfParent(leastOfParent),
      m_cover(set.size(), kFree),
      m_path(set.size(), kNone),
      m_place(set.size()) {
  const Eigen::Vector3d& spacing = set.geometry().spacing;
  for (unsigned axes = 1; axes < 8; ++axes) {
    const Eigen::Vector3d along(axes & 1U ? spacing[0] : 0, axes & 2U ? spacing[1] : 0,
                                axes & 4U ? spacing[2] : 0);
    m_lengthOf[axes] = static_cast<float>(along.norm());
  }
  findSteps(progress);
}

void VesselPaths::findSteps(const Progress& progress) {
  tbb::parallel_for(
      std::uint32_t{0}, static_cast<std::uint32_t>(m_set.size()), [&](std::uint32_t i) {
        progress.check();
        std::size_t next = kMostSteps * i;
        m_set.eachBeside(i, [&](std::uint32_t j, const Eigen::Vector3d& step) {
          if (!isOpen(std::min(i, j), std::max(i, j))) return;
          const std::uint32_t axes =
              (step[0] != 0 ? 1U : 0U) | (step[1] != 0 ? 2U : 0U) | (step[2] != 0 ? 4U : 0U);
          m_steps[next++] = axes << kAxesShift | j;
        });
      });
}

std::vector<std::uint32_t> VesselPaths::connectedPart(std::uint32_t voxel) const {
  std::vector<std::uint32_t> part(1, voxel);
  std::vector<bool> isSeen(m_set.size(), false);
  isSeen[voxel] = true;
  for (std::size_t k = 0; k < part.size(); ++k)
    eachStep(part[k], [&](std::uint32_t j, float) {
      if (!isSeen[j]) part.push_back(j);
      isSeen[j] = true;
    });
  return part;
}

// Balls that meet leave no room for a wall between their centres.
bool VesselPaths::isOpen(std::uint32_t i, std::uint32_t j) const {
  const Eigen::Vector3d a = m_set.position(i), b = m_set.position(j);
  return depths(i, j) >= (b - a).norm() || m_isOpen(a, b);
}

void VesselPaths::spread(std::uint32_t root, const Progress& progress) {
  for (const std::uint32_t i : m_skeleton.paths().reached()) m_path[i] = kNone;
  m_skeleton.spread(
      root, [this](std::uint32_t i, const auto& visit) { eachStep(i, visit); }, progress);
}

VesselPath VesselPaths::pathTo(std::uint32_t tip) const {
  VesselPath path;
  path.voxels = m_skeleton.paths().pathTo(tip, [&](std::uint32_t i) { return m_path[i] != kNone; });
  const std::uint32_t first = path.voxels.front();
  path.parent = m_path[first];
  if (path.parent != kNone) path.parentVoxel = m_place[first];
  return path;
}

bool VesselPaths::leavesVolume(std::uint32_t tip) const {
  const VolumeGeometry& geometry = m_set.geometry();
  const Cell cell = m_set.cell(tip);
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = depth(tip) / geometry.spacing[axis];
    if (cell[axis] < voxels || geometry.cells().size[axis] - 1 - cell[axis] < voxels) return true;
  }
  return false;
}

double VesselPaths::widthAround(std::uint32_t i) const {
  double width = depth(i);
  m_set.eachWithin(i, depth(i), [&](std::uint32_t j) {
    if (m_path[j] != kNone) width = std::max(width, depth(j));
  });
  return width;
}

bool VesselPaths::isVessel(VesselPath& path) const {
  if (path.voxels.size() < 2) return false;
  if (path.parent == kNone) return true;
  std::size_t out = 0;  // the first voxel beyond the balls of the paths before
  for (std::size_t i = 0; i < path.voxels.size(); ++i)
    if (m_cover[path.voxels[i]] == kInBall) out = i + 1;
  if (out >= path.voxels.size()) return false;
  const double length = m_skeleton.length(path.voxels.back()) - m_skeleton.length(path.voxels[out]);
  const auto depthAt = [&](std::size_t i) { return depth(path.voxels[i]); };
  // the parent's path may turn off its vessel before the place where this one leaves it
  double deepest = 0, neck = widthAround(path.voxels.front()), neckThere = neck;
  for (std::size_t i = 0; i < path.voxels.size(); ++i) {
    neck = std::min(neck, depthAt(i));
    if (i >= out && depthAt(i) > deepest) {
      deepest = depthAt(i);
      neckThere = neck;
    }
  }
  const double parent = depthAt(0);
  // both depths are known to half a voxel
  path.isSac = deepest > kSacDepthRatio * neckThere + m_set.geometry().voxelSize() &&
               length < 6 * deepest && !leavesVolume(path.voxels.back());
  const double least = std::max({path.isSac ? deepest : 2 * deepest, m_leastOfParent * parent,
                                 kLeastVoxels * m_set.geometry().voxelSize()});
  return length > least;
}

// The tip of a path that closes a loop lies in the middle of a lumen, near another path.
void VesselPaths::findLoop(VesselPath& path) const {
  const std::uint32_t tip = path.voxels.back();
  const double unit = m_set.geometry().voxelSize();
  const double reach = Skeleton::kCoverDepths * depth(tip) + (Skeleton::kCoverVoxels + 3) * unit;
  double best = std::numeric_limits<double>::infinity();
  m_set.eachWithin(tip, 2 * reach, [&](std::uint32_t j) {
    if (m_path[j] == kNone) return;
    const double across = (m_set.position(j) - m_set.position(tip)).norm();
    if (across > Skeleton::kCoverDepths * depth(j) + (Skeleton::kCoverVoxels + 2) * unit) return;
    // both paths back to where they part
    std::uint32_t a = tip, b = j;
    while (a != b && a != kNone && b != kNone) {
      std::uint32_t& later = m_skeleton.length(a) >= m_skeleton.length(b) ? a : b;
      later = m_skeleton.paths().before(later);
    }
    if (a != b || a == kNone) return;
    const double round = m_skeleton.length(tip) + m_skeleton.length(j) -
                         2 * static_cast<double>(m_skeleton.length(a));
    const double wide = depths(tip, j);
    if (round < kLoop * (across + wide) || !(across < best) || !isOpen(tip, j)) return;
    best = across;
    path.meets = m_path[j];
    path.meetsVoxel = m_place[j];
  });
}

// Voxels behind a wall, in a vessel that touches, are not covered.
void VesselPaths::coverAround(std::uint32_t i, bool isBall) {
  m_skeleton.eachCovered(i, [&](std::uint32_t j) {
    if (m_cover[j] == kFree && isOpen(i, j)) m_cover[j] = kNearBall;
  });
  if (isBall) m_set.eachWithin(i, depth(i), [&](std::uint32_t j) { m_cover[j] = kInBall; });
}

void VesselPaths::cover(const VesselPath& path) {
  float last = -CheapestPaths::kInfiniteCost;
  for (const std::uint32_t i : path.voxels) {
    if (i != path.voxels.back() && m_skeleton.length(i) - last < kBallStep * m_skeleton.depth(i))
      continue;
    last = m_skeleton.length(i);
    coverAround(i, true);
  }
}

std::vector<VesselPath> VesselPaths::find(std::uint32_t root, const Progress& progress) {
  spread(root, progress);
  std::vector<std::uint32_t> tips = m_skeleton.paths().reached();
  for (const std::uint32_t i : tips) {
    m_cover[i] = kFree;
    m_path[i] = kNone;
  }
  std::stable_sort(tips.begin(), tips.end(), [&](std::uint32_t a, std::uint32_t b) {
    return m_skeleton.length(a) > m_skeleton.length(b) ||
           (m_skeleton.length(a) == m_skeleton.length(b) && a < b);
  });
  std::vector<VesselPath> paths;
  for (const std::uint32_t tip : tips) {
    if (m_cover[tip] != kFree) continue;
    progress.check();
    VesselPath path = pathTo(tip);
    if (!isVessel(path)) {  // a corner or a bump, which other tips are in, too
      for (const std::uint32_t i : path.voxels)
        if (m_cover[i] != kInBall) coverAround(i, false);
      coverAround(tip, false);
      continue;
    }
    findLoop(path);
    append(std::move(path), paths);
  }
  return paths;
}

void VesselPaths::append(VesselPath path, std::vector<VesselPath>& paths) {
  for (std::size_t k = path.parent == kNone ? 0 : 1; k < path.voxels.size(); ++k) {
    m_path[path.voxels[k]] = static_cast<std::uint32_t>(paths.size());
    m_place[path.voxels[k]] = static_cast<std::uint32_t>(k);
  }
  cover(path);
  paths.push_back(std::move(path));
}

bool VesselPaths::addPath(std::uint32_t tip, std::vector<VesselPath>& paths) {
  VesselPath path = pathTo(tip);
  if (path.voxels.size() < 2) return false;
  append(std::move(path), paths);
  return true;
}

std::uint32_t VesselPaths::farthest(std::uint32_t from, const Progress& progress) {
  spread(from, progress);
  const std::vector<std::uint32_t>& part = m_skeleton.paths().reached();
  return *std::max_element(part.begin(), part.end(), [&](std::uint32_t a, std::uint32_t b) {
    return m_skeleton.length(a) < m_skeleton.length(b) ||
           (m_skeleton.length(a) == m_skeleton.length(b) && a > b);
  });
}

double VesselPaths::widthAtStart(const std::vector<std::uint32_t>& voxels) const {
  double width = 0;
  const Eigen::Vector3d tip = m_set.position(voxels.front());
  for (const std::uint32_t i : voxels) {
    const double away = (m_set.position(i) - tip).norm();
    if (away < depth(i)) continue;
    if (width == 0) width = depth(i);
    width = std::min(width, depth(i));
    if (away > kTip * depth(i)) break;
  }
  return width;
}

std::uint32_t VesselPaths::widestTip(std::uint32_t voxel, const Progress& progress) {
  const std::uint32_t far = farthest(voxel, progress);
  std::uint32_t best = far;
  double widest = 0;
  for (const VesselPath& path : find(far, progress)) {
    if (path.isSac || path.meets != kNone) continue;
    const auto tryTip = [&](const std::vector<std::uint32_t>& fromTip) {
      const double width = widthAtStart(fromTip);
      if (width <= widest) return;
      widest = width;
      best = fromTip.front();
    };
    tryTip({path.voxels.rbegin(), path.voxels.rend()});
    if (path.parent == kNone) tryTip(path.voxels);
  }
  return best;
}

}  // namespace lumen::convert
