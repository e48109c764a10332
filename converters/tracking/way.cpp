// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/way.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

#include "converters/common/statistics.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Cost of a millimetre: at the wall's level, where it rises with the square of what the middle is
/// missed by, and beyond the wall.
constexpr double kAtWall = 8, kBeyondWall = 60;
/// Voxels that a search may look at; beyond, it has lost its way.
constexpr std::size_t kMostVoxels = std::size_t{1} << 22;
/// Passes of smoothing of a way along lattice edges.
constexpr int kSmoothing = 6;

/// A box of the volume's lattice with what the search knows of each voxel.
class Lattice {
public:
  Lattice(const VolumeGeometry& geometry, const Vector3d& start, double reach)
      : m_geometry(geometry) {
    const Vector3d at = geometry.indexFromWorld(start);
    for (int a = 0; a < 3; ++a) {
      const double half = reach / geometry.spacing[a];
      const int last = geometry.size[static_cast<std::size_t>(a)] - 1;
      m_low[a] = static_cast<int>(std::clamp(std::floor(at[a] - half), 0.0, double(last)));
      const int high = static_cast<int>(std::clamp(std::ceil(at[a] + half), 0.0, double(last)));
      m_size[a] = high - m_low[a] + 1;
    }
  }
  [[nodiscard]] std::size_t count() const {
    return std::size_t(m_size[0]) * std::size_t(m_size[1]) * std::size_t(m_size[2]);
  }
  [[nodiscard]] std::optional<std::size_t> nearest(const Vector3d& world) const {
    const Vector3d at = m_geometry.indexFromWorld(world);
    Vector3i cell;
    for (int a = 0; a < 3; ++a) cell[a] = static_cast<int>(std::lround(at[a])) - m_low[a];
    if (!holds(cell)) return {};
    return place(cell);
  }
  [[nodiscard]] bool holds(const Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < m_size.array()).all();
  }
  [[nodiscard]] std::size_t place(const Vector3i& cell) const {
    return (std::size_t(cell[2]) * std::size_t(m_size[1]) + std::size_t(cell[1])) *
               std::size_t(m_size[0]) +
           std::size_t(cell[0]);
  }
  [[nodiscard]] Vector3i cell(std::size_t place) const {
    const std::size_t row = place / std::size_t(m_size[0]);
    return {static_cast<int>(place % std::size_t(m_size[0])),
            static_cast<int>(row % std::size_t(m_size[1])),
            static_cast<int>(row / std::size_t(m_size[1]))};
  }
  [[nodiscard]] Vector3d index(const Vector3i& cell) const { return (cell + m_low).cast<double>(); }

private:
  const VolumeGeometry& m_geometry;
  Vector3i m_low, m_size;
};

double costAt(const LumenLevels& levels, double value) {
  const double range = levels.middle - levels.wall;
  const double missed = range != 0 ? (levels.middle - value) / range : 0;
  if (!(missed > 0)) return 1;
  return missed < 1 ? 1 + (kAtWall - 1) * missed * missed : kBeyondWall;
}

Way smoothed(const TrackContext& context, const LumenLevels& levels, std::vector<Vector3d> points) {
  for (int pass = 0; pass < kSmoothing; ++pass) {
    std::vector<Vector3d> next = points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      next[i] = 0.25 * points[i - 1] + 0.5 * points[i] + 0.25 * points[i + 1];
    points = std::move(next);
  }
  Way way;
  const VolumeGeometry& geometry = context.volume.geometry();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step = (points[i] - points[i - 1]).norm();
    const Vector3d middle = 0.5 * (points[i] + points[i - 1]);
    const double value = context.volume.sample(geometry.indexFromWorld(middle));
    way.length += step;
    if (costAt(levels, value) >= kBeyondWall) way.outside += step;
  }
  way.points = std::move(points);
  return way;
}

}  // namespace

LumenLevels levelsOf(const BsplineVolume& volume, std::span<const TrackedNode> nodes) {
  const VolumeGeometry& geometry = volume.geometry();
  std::vector<double> middle, wall;
  for (const TrackedNode& node : nodes) {
    middle.push_back(volume.sample(geometry.indexFromWorld(node.centre)));
    std::vector<double> values;
    for (const formats::Vec3f& p : node.points) {
      const double value = volume.sample(geometry.indexFromWorld({p.x, p.y, p.z}));
      if (!std::isnan(value)) values.push_back(value);
    }
    if (!values.empty()) wall.push_back(median(std::move(values)));
  }
  if (wall.empty()) return {};
  return {median(std::move(middle)), median(std::move(wall))};
}

std::optional<Way> findWay(const TrackContext& context, const LumenLevels& levels,
                           const Vector3d& start, std::span<const Goal> goals, double reach) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const Lattice lattice(geometry, start, reach);
  const auto first = lattice.nearest(start);
  if (!first || lattice.count() > kMostVoxels) return {};
  std::vector<bool> done(lattice.count(), false);
  std::unordered_map<std::size_t, std::size_t> goalAt;  // the one of least surcharge in a voxel
  for (std::size_t g = 0; g < goals.size(); ++g)
    if (const auto at = lattice.nearest(goals[g].position)) {
      const auto [there, isNew] = goalAt.emplace(*at, g);
      if (!isNew && goals[g].surcharge < goals[there->second].surcharge) there->second = g;
    }
  if (goalAt.empty()) return {};
  constexpr float kFar = std::numeric_limits<float>::infinity();
  std::vector<float> cost(lattice.count(), kFar), price(lattice.count(), -1.0f);
  std::vector<std::uint32_t> from(lattice.count(), 0);
  const auto priceOf = [&](std::size_t place, const Vector3i& cell) {
    if (price[place] < 0)
      price[place] = static_cast<float>(costAt(levels, context.volume.sample(lattice.index(cell))));
    return price[place];
  };
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[*first] = 0;
  queue.push({0.0f, static_cast<std::uint32_t>(*first)});
  std::size_t taken = 0;
  float best = kFar;
  std::size_t bestPlace = 0, bestGoal = 0;
  while (!queue.empty()) {
    const auto [c, place] = queue.top();
    queue.pop();
    if (done[place]) continue;
    done[place] = true;
    if ((++taken & 1023U) == 0) context.progress.check();
    if (c >= best) break;
    if (const auto goal = goalAt.find(place); goal != goalAt.end()) {
      const float whole = c + static_cast<float>(goals[goal->second].surcharge);
      if (whole < best) {
        best = whole;
        bestPlace = place;
        bestGoal = goal->second;
      }
    }
    const Vector3i cell = lattice.cell(place);
    const float here = priceOf(place, cell);
    for (int n = 0; n < 27; ++n) {
      const Vector3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      const Vector3i next = cell + step;
      if (n == 13 || !lattice.holds(next)) continue;
      const std::size_t to = lattice.place(next);
      if (done[to]) continue;
      const double length = step.cast<double>().cwiseProduct(geometry.spacing).norm();
      const float reached = c + static_cast<float>(0.5 * length) * (here + priceOf(to, next));
      if (reached >= cost[to]) continue;
      cost[to] = reached;
      from[to] = static_cast<std::uint32_t>(place);
      queue.push({reached, static_cast<std::uint32_t>(to)});
    }
  }
  if (best == kFar) return {};
  std::vector<Vector3d> points;
  for (std::size_t at = bestPlace; at != *first; at = from[at])
    points.push_back(geometry.worldFromIndex(lattice.index(lattice.cell(at))));
  points.push_back(start);
  std::reverse(points.begin(), points.end());
  Way way = smoothed(context, levels, std::move(points));
  way.goal = bestGoal;
  return way;
}

}  // namespace lumen::convert
