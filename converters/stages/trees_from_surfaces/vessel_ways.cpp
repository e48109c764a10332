// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/vessel_ways.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include <tbb/parallel_for.h>

namespace lumen::convert {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNone = VesselWay::kNone;

// What a way covers: TEASAR's scale and offset.
constexpr double kCoverDepths = 1.5, kCoverVoxels = 2;
// Of the depth: balls closer to each other cover about the same.
constexpr float kBallStep = 0.25F;
// A way that is no longer than the vessel it leaves is deep is a corner of that vessel or a bump on it.
constexpr double kLeastOfParent = 0.5;
constexpr double kLeastVoxels = 3;
// Of the depth in the neck: a way that gets so much deeper behind it leads into a sac.
constexpr double kSac = 1.25;
// Way along the tree over the distance across: beyond that a tip has come back to a vessel by a loop.
constexpr double kLoop = 4;
constexpr std::size_t kCheckEvery = 1 << 14;

}  // namespace

VesselWays::VesselWays(const VoxelSet& set, std::span<const float> depths, const IsOpen& isOpen,
                       const Progress& progress)
    : m_set(set),
      m_depths(depths),
      m_isOpen(isOpen),
      m_steps(kMostSteps * set.size(), kNoStep),
      m_cost(set.size(), kFar),
      m_length(set.size()),
      m_from(set.size(), kNone),
      m_cover(set.size(), kFree),
      m_way(set.size(), kNone),
      m_place(set.size()) {
  for (std::size_t axes = 1; axes < 4; ++axes)
    m_lengthOf[axes] =
        static_cast<float>(set.geometry().voxelSize() * std::sqrt(static_cast<double>(axes)));
  findSteps(progress);
}

void VesselWays::findSteps(const Progress& progress) {
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(m_set.size()),
                    [&](std::uint32_t i) {
                      if (i % 1024 == 0) progress.check();
                      std::size_t next = kMostSteps * i;
                      m_set.eachBeside(i, [&](std::uint32_t j, const Eigen::Vector3d& way) {
                        if (!isOpen(std::min(i, j), std::max(i, j))) return;
                        const auto axes = static_cast<std::uint32_t>((way.array() != 0).count());
                        m_steps[next++] = axes << kAxesShift | j;
                      });
                    });
}

std::vector<std::uint32_t> VesselWays::partOf(std::uint32_t voxel) const {
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
bool VesselWays::isOpen(std::uint32_t i, std::uint32_t j) const {
  const Eigen::Vector3d a = m_set.position(i), b = m_set.position(j);
  return static_cast<double>(m_depths[i] + m_depths[j]) >= (b - a).norm() || m_isOpen(a, b);
}

void VesselWays::spread(std::uint32_t root, const Progress& progress) {
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const std::uint32_t i : m_part) {
    m_cost[i] = kFar;
    m_way[i] = kNone;
  }
  m_part.clear();
  const auto unit = static_cast<float>(m_set.geometry().voxelSize());
  m_cost[root] = 0;
  m_length[root] = 0;
  m_from[root] = kNone;
  queue.emplace(0.0F, root);
  for (std::size_t steps = 0; !queue.empty(); ++steps) {
    const auto [cost, i] = queue.top();
    queue.pop();
    if (cost > m_cost[i]) continue;
    m_part.push_back(i);
    if (steps % kCheckEvery == 0) progress.check();
    eachStep(i, [&, here = i, so = cost](std::uint32_t j, float length) {
      const float depth = m_depths[j] / unit + 0.25F;  // 0 at the wall
      const float price = so + length / (depth * depth * depth * depth);
      if (!(price < m_cost[j])) return;
      m_cost[j] = price;
      m_length[j] = m_length[here] + length;
      m_from[j] = here;
      queue.emplace(price, j);
    });
  }
}

VesselWay VesselWays::wayTo(std::uint32_t tip) const {
  VesselWay way;
  std::uint32_t at = tip;
  for (; at != kNone && m_way[at] == kNone; at = m_from[at]) way.voxels.push_back(at);
  if (at != kNone) {
    way.voxels.push_back(at);
    way.parent = m_way[at];
    way.parentVoxel = m_place[at];
  }
  std::reverse(way.voxels.begin(), way.voxels.end());
  return way;
}

bool VesselWays::isVessel(VesselWay& way) const {
  if (way.voxels.size() < 2) return false;
  if (way.parent == kNone) return true;
  std::size_t out = 0;  // the first voxel beyond the balls of the ways before
  for (std::size_t i = 0; i < way.voxels.size(); ++i)
    if (m_cover[way.voxels[i]] == kInBall) out = i + 1;
  if (out >= way.voxels.size()) return false;
  const double length = m_length[way.voxels.back()] - m_length[way.voxels[out]];
  const auto depth = [&](std::size_t i) { return static_cast<double>(m_depths[way.voxels[i]]); };
  double deepest = 0, neck = depth(0), neckThere = depth(0);
  for (std::size_t i = 0; i < way.voxels.size(); ++i) {
    neck = std::min(neck, depth(i));
    if (i >= out && depth(i) > deepest) {
      deepest = depth(i);
      neckThere = neck;
    }
  }
  const double parent = depth(0);
  way.isSac = deepest > kSac * neckThere && length < 6 * deepest;
  const double least = std::max({way.isSac ? deepest : 2 * deepest, kLeastOfParent * parent,
                                 kLeastVoxels * m_set.geometry().voxelSize()});
  return length > least;
}

// The tip of a way that comes round a loop lies in the middle of a lumen, near another way.
void VesselWays::findLoop(VesselWay& way) const {
  const std::uint32_t tip = way.voxels.back();
  const double unit = m_set.geometry().voxelSize();
  const double reach =
      kCoverDepths * static_cast<double>(m_depths[tip]) + (kCoverVoxels + 3) * unit;
  double best = kFar;
  m_set.eachWithin(tip, 2 * reach, [&](std::uint32_t j) {
    if (m_way[j] == kNone) return;
    const double across = (m_set.position(j) - m_set.position(tip)).norm();
    if (across > kCoverDepths * static_cast<double>(m_depths[j]) + (kCoverVoxels + 2) * unit)
      return;
    // both ways back to where they part
    std::uint32_t a = tip, b = j;
    while (a != b && a != kNone && b != kNone) {
      std::uint32_t& later = m_length[a] >= m_length[b] ? a : b;
      later = m_from[later];
    }
    if (a != b || a == kNone) return;
    const double round = m_length[tip] + m_length[j] - 2 * static_cast<double>(m_length[a]);
    const double wide = static_cast<double>(m_depths[tip] + m_depths[j]);
    if (round < kLoop * (across + wide) || !(across < best) || !isOpen(tip, j)) return;
    best = across;
    way.meets = m_way[j];
    way.meetsVoxel = m_place[j];
  });
}

// What lies behind a wall, in a vessel that touches, is not covered.
void VesselWays::coverAround(std::uint32_t i, bool isBall) {
  const auto depth = static_cast<double>(m_depths[i]);
  const double more = kCoverVoxels * m_set.geometry().voxelSize();
  m_set.eachWithin(i, kCoverDepths * depth + more, [&](std::uint32_t j) {
    if (m_cover[j] == kFree && isOpen(i, j)) m_cover[j] = kNear;
  });
  if (isBall) m_set.eachWithin(i, depth, [&](std::uint32_t j) { m_cover[j] = kInBall; });
}

void VesselWays::cover(const VesselWay& way) {
  float last = -kFar;
  for (const std::uint32_t i : way.voxels) {
    if (i != way.voxels.back() && m_length[i] - last < kBallStep * m_depths[i]) continue;
    last = m_length[i];
    coverAround(i, true);
  }
}

std::vector<VesselWay> VesselWays::find(std::uint32_t root, const Progress& progress) {
  spread(root, progress);
  for (const std::uint32_t i : m_part) {
    m_cover[i] = kFree;
    m_way[i] = kNone;
  }
  std::vector<std::uint32_t> tips = m_part;
  std::stable_sort(tips.begin(), tips.end(), [&](std::uint32_t a, std::uint32_t b) {
    return m_length[a] > m_length[b] || (m_length[a] == m_length[b] && a < b);
  });
  std::vector<VesselWay> ways;
  for (const std::uint32_t tip : tips) {
    if (m_cover[tip] != kFree) continue;
    progress.check();
    VesselWay way = wayTo(tip);
    if (!isVessel(way)) {  // a corner or a bump, which other tips are in, too
      for (const std::uint32_t i : way.voxels)
        if (m_cover[i] != kInBall) coverAround(i, false);
      coverAround(tip, false);
      continue;
    }
    findLoop(way);
    for (std::size_t k = way.parent == kNone ? 0 : 1; k < way.voxels.size(); ++k) {
      m_way[way.voxels[k]] = static_cast<std::uint32_t>(ways.size());
      m_place[way.voxels[k]] = static_cast<std::uint32_t>(k);
    }
    cover(way);
    ways.push_back(std::move(way));
  }
  return ways;
}

std::uint32_t VesselWays::farthest(std::uint32_t from, const Progress& progress) {
  spread(from, progress);
  return *std::max_element(m_part.begin(), m_part.end(), [&](std::uint32_t a, std::uint32_t b) {
    return m_length[a] < m_length[b] || (m_length[a] == m_length[b] && a > b);
  });
}

}  // namespace lumen::convert
