// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/skeleton_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

/// States of `free`.
enum State : std::uint8_t { kTaken = 0, kInGroup = 2 };

constexpr std::size_t kChord = 5;  // voxels: a path along the grid is longer than its vessel

}  // namespace

SkeletonPath SkeletonPaths::pathTo(std::uint32_t tip) const {
  const VoxelSet& set = m_skeleton.voxels();
  SkeletonPath path;
  path.voxels =  // an earlier path covers the first voxel
      m_skeleton.paths().pathTo(tip, [&](std::uint32_t i) { return m_free[i] != kInGroup; });
  path.length = set.geometry().voxelSize();  // half a voxel beyond either end
  for (std::size_t i = 0; i + 1 < path.voxels.size(); i += kChord) {
    const std::size_t next = std::min(i + kChord, path.voxels.size() - 1);
    path.length += (set.position(path.voxels[next]) - set.position(path.voxels[i])).norm();
  }
  return path;
}

void SkeletonPaths::cover(SkeletonPath& path) {
  const VolumeGeometry& geometry = m_skeleton.voxels().geometry();
  for (const std::uint32_t i : path.voxels)
    m_skeleton.eachCovered(i, [&](std::uint32_t j) {
      path.covered += m_free[j] == kInGroup;
      if (m_free[j] == kInGroup) m_free[j] = kTaken;
    });
  // depths come in steps of about half a voxel, and volumes include the beginnings of side branches
  std::vector<float> depths;
  for (const std::uint32_t i : path.voxels) depths.push_back(m_skeleton.depth(i));
  const auto depth = static_cast<double>(upperMedian(depths));
  const double volume = static_cast<double>(path.covered) * geometry.spacing.prod();
  path.radius = std::clamp(std::sqrt(volume / (std::numbers::pi * path.length)), depth,
                           depth + geometry.voxelSize());
}

std::size_t SkeletonPaths::split(std::uint32_t root, double least, std::size_t leastVoxels,
                                 const Progress& progress, std::vector<SkeletonPath>& out) {
  const VoxelSet& set = m_skeleton.voxels();
  const auto eachBeside = [&](std::uint32_t i, const auto& visit) {
    set.eachBeside(i, [&](std::uint32_t j, const Eigen::Vector3d& step) {
      if (m_free[j] != kTaken) visit(j, static_cast<float>(step.norm()));
    });
  };
  m_skeleton.spread(root, eachBeside, progress);
  std::vector<std::uint32_t> group = m_skeleton.paths().reached();
  for (const std::uint32_t i : group) m_free[i] = kInGroup;
  std::stable_sort(group.begin(), group.end(), [&](std::uint32_t a, std::uint32_t b) {
    return m_skeleton.paths().cost(a) > m_skeleton.paths().cost(b);
  });
  for (const std::uint32_t tip : group) {
    if (group.size() < leastVoxels || m_free[tip] != kInGroup) continue;
    progress.check();
    SkeletonPath path = pathTo(tip);
    cover(path);
    if (path.length >= least) out.push_back(std::move(path));
  }
  for (const std::uint32_t i : group) m_free[i] = kTaken;
  return group.size();
}

}  // namespace lumen::convert
