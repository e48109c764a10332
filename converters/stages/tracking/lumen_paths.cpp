// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/lumen_paths.h"

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

/// Passes of smoothing of a path along lattice edges.
constexpr int kSmoothingPasses = 6;
/// Radii beyond which voxels are outside of a lumen; the blur of its rim comes on top.
constexpr double kRimRadii = 1.15;
/// The price of a millimetre at the wall's level, and beyond it.
constexpr double kAtWallPrice = 8, kBeyondWallPrice = 60;

/// The price of a millimetre at an intensity: 1 in the lumen's middle, more with the square of the
/// distance from the middle's level up to the wall's, and much more beyond.
double priceAt(const LumenLevels& levels, double value) {
  const double range = levels.middle - levels.wall;
  const double missed = range != 0 ? (levels.middle - value) / range : 0;
  if (std::isnan(value)) return kBeyondWallPrice;
  if (missed <= 0) return 1;
  return missed < 1 ? 1 + (kAtWallPrice - 1) * missed * missed : kBeyondWallPrice;
}

/// The price of a millimetre at a voxel.
struct VoxelPrice {
  const TrackContext& context;
  const LumenLevels& levels;
  float operator()(const Cell& cell) const {
    return static_cast<float>(priceAt(levels, context.volume.sample(cell.cast<double>())));
  }
};

Path smoothed(const TrackContext& context, const LumenLevels& levels,
              std::vector<Vector3d> points) {
  for (int pass = 0; pass < kSmoothingPasses; ++pass) {
    std::vector<Vector3d> next = points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      next[i] = 0.25 * points[i - 1] + 0.5 * points[i] + 0.25 * points[i + 1];
    points = std::move(next);
  }
  Path path;
  const VolumeGeometry& geometry = context.volume.geometry();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step = (points[i] - points[i - 1]).norm();
    const Vector3d middle = 0.5 * (points[i] + points[i - 1]);
    const double value = context.volume.sample(geometry.indexFromWorld(middle));
    path.length += step;
    if (priceAt(levels, value) >= kBeyondWallPrice) path.outside += step;
  }
  path.points = std::move(points);
  return path;
}

/// The lumen that a path has passed when it comes to a voxel: its own only, another vessel's, or
/// another's and then its own again.
enum class PathPart : std::uint8_t { Own, Other, Beyond, Closed };

/// The parts of the paths of a search, and their lengths.
class PathParts {
public:
  PathParts(CubeSearch& search, const PathStart& start)
      : m_search(search),
        m_start(start),
        m_isOther(search.count(), false),
        m_part(search.count(), PathPart::Own),
        m_length(search.count(), 0.0F) {
    for (const WorldBall& ball : start.others)
      for (const std::size_t voxel : search.voxelsIn(ball)) m_isOther[voxel] = true;
    for (const WorldBall& ball : start.closed)
      for (const std::size_t voxel : search.voxelsIn(ball)) search.exclude(voxel);
    for (const WorldBall& ball : start.behind)
      for (const std::size_t voxel : search.voxelsIn(ball))
        if (along(voxel) < 0) search.exclude(voxel);
  }

  /// The part at a voxel that the search has come to, after all voxels before it on its path.
  PathPart at(std::size_t voxel) {
    const std::size_t before = m_search.before(voxel);
    if (before == voxel) return PathPart::Own;
    m_length[voxel] =
        m_length[before] +
        static_cast<float>((m_search.position(voxel) - m_search.position(before)).norm());
    PathPart there = m_part[before];
    if (m_isOther[voxel]) {
      if (there == PathPart::Beyond ||
          (there == PathPart::Own && m_length[voxel] > m_start.through))
        there = PathPart::Closed;
      else
        there = PathPart::Other;
    } else if (there == PathPart::Other) {
      there = PathPart::Beyond;
    }
    return m_part[voxel] = there;
  }
  [[nodiscard]] double lengthTo(std::size_t voxel) const { return double{m_length[voxel]}; }
  [[nodiscard]] bool isAhead(std::size_t voxel) const { return along(voxel) > 0; }

private:
  [[nodiscard]] double along(std::size_t voxel) const {
    return (m_search.position(voxel) - m_start.place).dot(m_start.direction);
  }

  CubeSearch& m_search;
  const PathStart& m_start;
  std::vector<bool> m_isOther;
  std::vector<PathPart> m_part;
  std::vector<float> m_length;
};

/// Voxels at the front of a search, in groups that touch; each in the order of their cost.
std::vector<std::vector<std::size_t>> groupTouching(const CubeSearch& search,
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

/// The radius of a disc as large as N voxels that lie side by side, mm.
double radiusOfDisc(std::size_t voxels, const VolumeGeometry& geometry) {
  const double face = std::pow(geometry.spacing.prod(), 2.0 / 3.0);
  return std::sqrt(static_cast<double>(voxels) * face / std::numbers::pi);
}

}  // namespace

void addLumen(std::span<const TrackedNode> nodes, const VolumeGeometry& geometry,
              std::vector<WorldBall>& balls) {
  const double blur = 0.5 * geometry.voxelSize();
  for (const TrackedNode& node : nodes)
    balls.push_back({node.centre, kRimRadii * node.radius + blur});
}

LumenLevels measureLevels(const BsplineVolume& volume, std::span<const TrackedNode> nodes) {
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

std::optional<Path> findPath(const TrackContext& context, const LumenLevels& levels,
                             const Vector3d& start, std::span<const PathGoal> goals, double reach) {
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
  search.run(VoxelPrice{context, levels}, CheapestPaths::kInfiniteCost, visit, context.progress);
  if (!std::isfinite(best)) return {};
  Path path = smoothed(context, levels, search.pathTo(bestVoxel));
  path.goal = bestGoal;
  return path;
}

PathsBeyond pathsBeyond(const TrackContext& context, const LumenLevels& levels,
                        const PathStart& start, double distance) {
  PathsBeyond beyond;
  CubeSearch search(context.volume.geometry(), start.place, distance);
  if (!search.isPossible()) return beyond;
  PathParts parts(search, start);
  std::vector<std::size_t> front;
  const auto visit = [&](std::size_t voxel, double) {
    const PathPart there = parts.at(voxel);
    if (there == PathPart::Closed) return SearchStep::GoNoFurther;
    const double length = parts.lengthTo(voxel);
    if (there != PathPart::Other)
      beyond.visible = std::max(beyond.visible, std::min(length, distance));
    if (length < distance) return SearchStep::GoOn;
    beyond.isAll = false;
    if (there == PathPart::Own || (there == PathPart::Beyond && parts.isAhead(voxel)))
      front.push_back(voxel);
    return SearchStep::GoNoFurther;
  };
  search.run(VoxelPrice{context, levels}, static_cast<float>(kBeyondWallPrice), visit,
             context.progress);
  for (const auto& group : groupTouching(search, front)) {
    beyond.paths.push_back(smoothed(context, levels, search.pathTo(group.front())));
    beyond.paths.back().breadth = radiusOfDisc(group.size(), context.volume.geometry());
  }
  return beyond;
}

}  // namespace lumen::convert
