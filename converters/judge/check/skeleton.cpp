// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/skeleton.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <utility>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

/// States of Skeleton's `free`.
enum State : std::uint8_t { kTaken = 0, kFree = 1, kInGroup = 2 };

constexpr double kCoverDepths = 1.5, kCoverVoxels = 2;  // what a way covers; TEASAR's scale, offset
constexpr std::size_t kChord = 5;  // voxels: a way along the grid is longer than its vessel
constexpr std::size_t kCheckEvery = 1 << 14;  // voxels: well below 100 ms
}  // namespace

// A step costs its length by the square of the depth: in the middle it is cheap.
void Skeleton::spread(std::uint32_t root, const Progress& progress) {
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  m_group.clear();
  const auto reach = [&](std::uint32_t i, std::uint32_t from, float cost) {
    if (m_free[i] == kTaken || (m_free[i] == kInGroup && !(cost < m_cost[i]))) return;
    if (m_free[i] == kFree) m_group.push_back(i);
    m_free[i] = kInGroup;
    m_cost[i] = cost;
    m_from[i] = from;
    queue.emplace(cost, i);
  };
  for (reach(root, VoxelSet::kNone, 0); !queue.empty();) {
    const auto [cost, i] = queue.top();
    queue.pop();
    if (cost > m_cost[i]) continue;
    if (i % kCheckEvery == 0) progress.check();
    m_set.eachBeside(i, [&, here = i, so = cost](std::uint32_t j, const Eigen::Vector3d& way) {
      reach(j, here, so + static_cast<float>(way.norm()) / (m_depths[j] * m_depths[j]));
    });
  }
}

SkeletonWay Skeleton::wayTo(std::uint32_t tip) const {
  SkeletonWay way;
  std::uint32_t at = tip;
  for (; at != VoxelSet::kNone && m_free[at] == kInGroup; at = m_from[at]) way.voxels.push_back(at);
  if (at != VoxelSet::kNone) way.voxels.push_back(at);  // on the way before it
  std::reverse(way.voxels.begin(), way.voxels.end());
  way.length = m_set.geometry().voxelSize();  // half a voxel beyond either end
  for (std::size_t i = 0; i + 1 < way.voxels.size(); i += kChord) {
    const std::size_t next = std::min(i + kChord, way.voxels.size() - 1);
    way.length += (m_set.position(way.voxels[next]) - m_set.position(way.voxels[i])).norm();
  }
  return way;
}

void Skeleton::cover(SkeletonWay& way) {
  const double more = kCoverVoxels * m_set.geometry().voxelSize();
  for (const std::uint32_t i : way.voxels)
    m_set.eachWithin(i, kCoverDepths * static_cast<double>(m_depths[i]) + more,
                     [&](std::uint32_t j) {
                       way.covered += m_free[j] == kInGroup;
                       if (m_free[j] == kInGroup) m_free[j] = kTaken;
                     });
  // depths come in steps of about half a voxel, and volumes have the beginnings of side branches
  std::vector<float> depths;
  for (const std::uint32_t i : way.voxels) depths.push_back(m_depths[i]);
  const auto depth = static_cast<double>(upperMedian(depths));
  const double volume = static_cast<double>(way.covered) * m_set.geometry().spacing.prod();
  way.radius = std::clamp(std::sqrt(volume / (std::numbers::pi * way.length)), depth,
                          depth + m_set.geometry().voxelSize());
}

std::size_t Skeleton::split(std::uint32_t root, double least, std::size_t leastVoxels,
                            const Progress& progress, std::vector<SkeletonWay>& out) {
  spread(root, progress);
  std::stable_sort(m_group.begin(), m_group.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return m_cost[a] > m_cost[b]; });
  for (const std::uint32_t tip : m_group) {
    if (m_group.size() < leastVoxels || m_free[tip] != kInGroup) continue;
    progress.check();
    SkeletonWay way = wayTo(tip);
    cover(way);
    if (way.length >= least) out.push_back(std::move(way));
  }
  for (const std::uint32_t i : m_group) m_free[i] = kTaken;
  return m_group.size();
}

}  // namespace lumen::convert
