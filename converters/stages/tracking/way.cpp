// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/way.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Passes of smoothing of a way along lattice edges.
constexpr int kSmoothing = 6;

/// The price of a millimetre at a voxel.
struct PriceAt {
  const TrackContext& context;
  const LumenLevels& levels;
  float operator()(const Cell& cell) const {
    const double value = context.volume.sample(cell.cast<double>());
    return static_cast<float>(lumenPrice(levels, value));
  }
};

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
    if (lumenPrice(levels, value) >= kBeyondWallPrice) way.outside += step;
  }
  way.points = std::move(points);
  return way;
}

/// What a way has passed when it comes to a voxel: its own lumen only, another vessel's, or that and
/// its own again.
enum class Stretch : std::uint8_t { Own, Other, Beyond, Closed };

/// The stretches of the ways of a search, and their lengths.
class Stretches {
public:
  Stretches(CubeSearch& search, const Outset& outset)
      : m_search(search),
        m_outset(outset),
        m_isOther(search.count(), false),
        m_stretch(search.count(), Stretch::Own),
        m_length(search.count(), 0.0F) {
    for (const Ball& ball : outset.others)
      for (const std::size_t voxel : search.voxelsIn(ball)) m_isOther[voxel] = true;
    for (const Ball& ball : outset.closed)
      for (const std::size_t voxel : search.voxelsIn(ball)) search.exclude(voxel);
    for (const Ball& ball : outset.behind)
      for (const std::size_t voxel : search.voxelsIn(ball))
        if (along(voxel) < 0) search.exclude(voxel);
  }

  /// Of a voxel that the search has come to, after all on its way.
  Stretch at(std::size_t voxel) {
    const std::size_t before = m_search.before(voxel);
    if (before == voxel) return Stretch::Own;
    m_length[voxel] =
        m_length[before] +
        static_cast<float>((m_search.position(voxel) - m_search.position(before)).norm());
    Stretch there = m_stretch[before];
    if (m_isOther[voxel]) {
      if (there == Stretch::Beyond || (there == Stretch::Own && m_length[voxel] > m_outset.through))
        there = Stretch::Closed;
      else
        there = Stretch::Other;
    } else if (there == Stretch::Other) {
      there = Stretch::Beyond;
    }
    return m_stretch[voxel] = there;
  }
  [[nodiscard]] double lengthTo(std::size_t voxel) const { return double{m_length[voxel]}; }
  [[nodiscard]] bool isAhead(std::size_t voxel) const { return along(voxel) > 0; }

private:
  [[nodiscard]] double along(std::size_t voxel) const {
    return (m_search.position(voxel) - m_outset.place).dot(m_outset.direction);
  }

  CubeSearch& m_search;
  const Outset& m_outset;
  std::vector<bool> m_isOther;
  std::vector<Stretch> m_stretch;
  std::vector<float> m_length;
};

/// Voxels at the front of a search, in groups that touch; each in the order of their cost.
std::vector<std::vector<std::size_t>> groupsOf(const CubeSearch& search,
                                               const std::vector<std::size_t>& front) {
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t voxel : front) {
    std::size_t into = groups.size();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const bool touches = std::any_of(groups[g].begin(), groups[g].end(), [&](std::size_t other) {
        return search.areNeighbours(voxel, other);
      });
      if (!touches) continue;
      if (into == groups.size()) {
        into = g;
        continue;
      }
      groups[into].insert(groups[into].end(), groups[g].begin(), groups[g].end());
      groups[g].clear();
    }
    if (into == groups.size()) groups.emplace_back();
    groups[into].push_back(voxel);
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

/// The radius of a disc as large as so many voxels that lie side by side, mm.
double breadthOf(std::size_t voxels, const VolumeGeometry& geometry) {
  const double face = std::pow(geometry.spacing.prod(), 2.0 / 3.0);
  return std::sqrt(static_cast<double>(voxels) * face / std::numbers::pi);
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
  CubeSearch search(context.volume.geometry(), start, reach);
  if (!search.isPossible()) return {};
  std::unordered_map<std::size_t, std::size_t> goalAt;  // the one of least surcharge in a voxel
  for (std::size_t g = 0; g < goals.size(); ++g) {
    const std::size_t at = search.voxelAt(goals[g].position);
    if (at == CubeSearch::kNowhere) continue;
    const auto [there, isNew] = goalAt.emplace(at, g);
    if (!isNew && goals[g].surcharge < goals[there->second].surcharge) there->second = g;
  }
  if (goalAt.empty()) return {};
  double best = std::numeric_limits<double>::infinity();
  std::size_t bestVoxel = 0, bestGoal = 0;
  const auto visit = [&](std::size_t voxel, double cost) {
    if (cost >= best) return SearchStep::Stop;
    const auto goal = goalAt.find(voxel);
    if (goal == goalAt.end()) return SearchStep::GoOn;
    const double whole = cost + goals[goal->second].surcharge;
    if (whole < best) {
      best = whole;
      bestVoxel = voxel;
      bestGoal = goal->second;
    }
    return SearchStep::GoOn;
  };
  search.run(PriceAt{context, levels}, CheapestPaths::kFar, visit, context.progress);
  if (!std::isfinite(best)) return {};
  Way way = smoothed(context, levels, search.pathTo(bestVoxel));
  way.goal = bestGoal;
  return way;
}

WaysOnward waysOnward(const TrackContext& context, const LumenLevels& levels, const Outset& outset,
                      double distance) {
  WaysOnward onward;
  CubeSearch search(context.volume.geometry(), outset.place, distance);
  if (!search.isPossible()) return onward;
  Stretches stretches(search, outset);
  std::vector<std::size_t> front;
  const auto visit = [&](std::size_t voxel, double) {
    const Stretch there = stretches.at(voxel);
    if (there == Stretch::Closed) return SearchStep::GoNoFurther;
    const double length = stretches.lengthTo(voxel);
    if (there != Stretch::Other)
      onward.visible = std::max(onward.visible, std::min(length, distance));
    if (length < distance) return SearchStep::GoOn;
    onward.isAll = false;
    if (there == Stretch::Own || (there == Stretch::Beyond && stretches.isAhead(voxel)))
      front.push_back(voxel);
    return SearchStep::GoNoFurther;
  };
  search.run(PriceAt{context, levels}, static_cast<float>(kBeyondWallPrice), visit,
             context.progress);
  for (const auto& group : groupsOf(search, front)) {
    onward.ways.push_back(smoothed(context, levels, search.pathTo(group.front())));
    onward.ways.back().breadth = breadthOf(group.size(), context.volume.geometry());
  }
  return onward;
}

}  // namespace lumen::convert
