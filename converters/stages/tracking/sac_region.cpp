// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/sac_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "converters/voxels/depth.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Half of the width of a passage that continues within the sac, in radii of the least ball.
constexpr double kHalfPassageRadii = 0.25;
/// Voxels: extent of the sac beyond the reach of a ball of half a passage's width, for corners.
constexpr double kCorner = 1.5;
/// Voxels in a box: beyond, a radius was mistyped.
constexpr std::size_t kMostInBox = std::size_t{1} << 24;
/// Voxels: a profile across the wall, from inside to outside, and the spacing of its samples.
constexpr double kInward = 2.0, kOutward = 2.5, kProfileStep = 0.125;
constexpr auto kProfile = static_cast<std::size_t>((kInward + kOutward) / kProfileStep) + 1;
/// Samples before and behind a place whose difference is the fall there: half a voxel apart.
constexpr std::size_t kHalfFall = 2;

constexpr double kNoPlace = std::numeric_limits<double>::infinity();

/// Marks with `reached` the voxels that are joined to the places in `queue` by faces of voxels
/// marked `open`.
void flood(const CellBox& box, std::vector<std::uint8_t>& mark, std::uint8_t open,
           std::uint8_t reached, std::vector<std::size_t> queue) {
  std::erase_if(queue, [&](std::size_t place) { return mark[place] != open; });
  for (const std::size_t place : queue) mark[place] = reached;
  while (!queue.empty()) {
    const Cell cell = box.cell(queue.back());
    queue.pop_back();
    for (const Cell& step : kFaceSteps) {
      const Cell next = cell + step;
      if (!box.contains(next)) continue;
      const std::size_t place = box.index(next);
      if (mark[place] != open) continue;
      mark[place] = reached;
      queue.push_back(place);
    }
  }
}

CellBox boxAround(const VolumeGeometry& geometry, std::span<const SacBall> balls) {
  Vector3d low = Vector3d::Constant(kNoPlace), high = Vector3d::Constant(-kNoPlace);
  for (const SacBall& ball : balls) {
    const Vector3d at = geometry.indexFromWorld(ball.centre);
    const Vector3d half = (kSacReach * ball.radius / geometry.spacing.array()).matrix();
    low = low.cwiseMin(at - half);
    high = high.cwiseMax(at + half);
  }
  return geometry.cellsAround(low, high);
}

/// 1 where the volume is lumen, holes within it included, else 0.
std::vector<std::uint8_t> lumenIn(const TrackContext& context, double wallLevel,
                                  const CellBox& box) {
  constexpr std::uint8_t kDark = 0, kLumen = 1, kOpen = 2;
  const float sign = context.options.dark ? -1.0F : 1.0F;
  std::vector<std::uint8_t> mark(box.count(), kDark);
  std::vector<float> row(static_cast<std::size_t>(box.size.x()));
  for (std::size_t start = 0; start < mark.size(); start += row.size()) {
    context.progress.check();
    context.volume.sampleLine(box.cell(start).cast<double>(), Vector3d::UnitX(), row);
    for (std::size_t i = 0; i < row.size(); ++i)
      if (sign * (row[i] - static_cast<float>(wallLevel)) > 0) mark[start + i] = kLumen;
  }
  std::vector<std::size_t> rim;
  for (std::size_t place = 0; place < mark.size(); ++place) {
    const Cell cell = box.cell(place);
    if ((cell.array() == box.low.array()).any() || (cell.array() == box.high().array()).any())
      rim.push_back(place);
  }
  flood(box, mark, kDark, kOpen, std::move(rim));
  for (std::uint8_t& m : mark) m = m == kOpen ? kDark : kLumen;
  return mark;
}

/// The deepest voxels within half a ball's radius of its centre.
std::vector<std::size_t> deepestIn(const VolumeGeometry& geometry, const SacRegion& region,
                                   std::span<const SacBall> balls) {
  std::vector<std::size_t> out;
  for (const SacBall& ball : balls) {
    const SacBall half{ball.centre, 0.5 * ball.radius / kSacReach};
    std::optional<std::size_t> best;
    boxAround(geometry, {&half, 1}).forEach([&](const Cell& cell) {
      if (!region.box.contains(cell) ||
          (geometry.position(cell) - ball.centre).norm() > 0.5 * ball.radius)
        return;
      const std::size_t place = region.box.index(cell);
      if (!best || region.depth[place] > region.depth[*best]) best = place;
    });
    if (best) out.push_back(*best);
  }
  return out;
}

bool isInReach(std::span<const SacBall> balls, const Vector3d& p) {
  return std::any_of(balls.begin(), balls.end(), [&](const SacBall& ball) {
    return (p - ball.centre).norm() < kSacReach * ball.radius;
  });
}

/// The sum of the steps from a cell to those beside it that are in no lumen.
Vector3d sumOutward(const SacRegion& region, const Cell& cell) {
  Vector3d sum = Vector3d::Zero();
  for (const Cell& step : kFaceSteps) {
    const Cell next = cell + step;
    if (region.box.contains(next) && region.depth[region.box.index(next)] == 0)
      sum += step.cast<double>();
  }
  return sum;
}

/// One voxel's length along the fall of the intensity, in index space; zero where it is flat.
Vector3d downhill(const TrackContext& context, const Vector3d& at) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const float sign = context.options.dark ? -1.0F : 1.0F;
  Vector3d fall;
  for (int a = 0; a < 3; ++a) {
    const Vector3d half = 0.5 * Vector3d::Unit(a);
    const float change = context.volume.sample(at - half) - context.volume.sample(at + half);
    fall[a] = static_cast<double>(sign * change) / geometry.spacing[a];
  }
  if (!(fall.norm() > 0)) return Vector3d::Zero();
  return (geometry.voxelSize() * fall.normalized()).cwiseQuotient(geometry.spacing);
}

/// Adds the place of the steepest fall on a line through the wall; `values` is a buffer.
void addWall(const TrackContext& context, const Vector3d& at, const Vector3d& direction,
             std::vector<float>& values, SacWall& wall) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const float sign = context.options.dark ? -1.0F : 1.0F;
  context.volume.sampleLine(at - kInward * direction, kProfileStep * direction, values);
  std::size_t best = 0;
  float strongest = 0;
  for (std::size_t n = kHalfFall; n + kHalfFall < values.size(); ++n) {
    const float fall = sign * (values[n - kHalfFall] - values[n + kHalfFall]);
    if (fall > strongest) {
      strongest = fall;
      best = n;
    }
  }
  if (best == 0) return;
  const double along = static_cast<double>(best) * kProfileStep - kInward;
  wall.points.push_back(geometry.worldFromIndex(at + along * direction));
  wall.strength.push_back(static_cast<double>(strongest) /
                          (2 * kHalfFall * kProfileStep * geometry.voxelSize()));
}

}  // namespace

double leastPassage(std::span<const SacBall> balls) {
  double least = kNoPlace;
  for (const SacBall& ball : balls) least = std::min(least, ball.radius);
  return kHalfPassageRadii * least;
}

std::optional<SacRegion> growSac(const TrackContext& context, double wallLevel,
                                 std::span<const SacBall> balls,
                                 const std::function<bool(const Vector3d&)>& inVessel) {
  constexpr std::uint8_t kNone = 0, kDeep = 1, kJoined = 2;
  const VolumeGeometry& geometry = context.volume.geometry();
  SacRegion region;
  region.box = boxAround(geometry, balls);
  if (region.box.count() > kMostInBox) return {};
  region.isSac = lumenIn(context, wallLevel, region.box);
  region.depth = distancesTo(region.box, geometry.spacing, region.isSac, 0, context.progress);
  const double coarsest = geometry.spacing.maxCoeff();
  const double half = std::max(leastPassage(balls), coarsest);
  std::vector<std::uint8_t> core(region.isSac.size(), kNone);
  for (std::size_t i = 0; i < core.size(); ++i) {
    context.progress.check();
    if (!region.isSac[i]) continue;
    const Vector3d p = geometry.position(region.box.cell(i));
    region.isSac[i] = isInReach(balls, p) && !inVessel(p);
    if (region.isSac[i] && region.depth[i] > half) core[i] = kDeep;
  }
  flood(region.box, core, kDeep, kJoined, deepestIn(geometry, region, balls));
  const auto fromCore = distancesTo(region.box, geometry.spacing, core, kJoined, context.progress);
  bool isEmpty = true;
  for (std::size_t i = 0; i < core.size(); ++i) {
    region.isSac[i] = region.isSac[i] && fromCore[i] < half + kCorner * coarsest;
    isEmpty = isEmpty && !region.isSac[i];
  }
  if (isEmpty) return {};
  return region;
}

SacWall measureSacWall(const TrackContext& context, const SacRegion& region) {
  SacWall wall;
  std::vector<float> values(kProfile);
  for (std::size_t i = 0; i < region.isSac.size(); ++i) {
    context.progress.check();
    if (!region.isSac[i]) continue;
    const Cell cell = region.box.cell(i);
    const Vector3d outside = sumOutward(region, cell);
    if ((outside.array() == 0).all()) continue;
    const Vector3d at = cell.cast<double>(), direction = downhill(context, at);
    if (direction.dot(outside) > 0) addWall(context, at, direction, values, wall);
  }
  return wall;
}

std::vector<Vector3d> thinnedOut(std::span<const Vector3d> points, double apart) {
  const auto key = [](const Vector3i& cell) {
    return (std::uint64_t(std::uint32_t(cell[0])) * 0x9E3779B97F4A7C15U) ^
           (std::uint64_t(std::uint32_t(cell[1])) * 0xC2B2AE3D27D4EB4FU) ^
           (std::uint64_t(std::uint32_t(cell[2])) * 0x165667B19E3779F9U);
  };
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> grid;
  std::vector<Vector3d> kept;
  for (const Vector3d& p : points) {
    const Vector3i cell = (p / apart).array().floor().matrix().cast<int>();
    bool isCovered = false;
    for (int n = 0; n < 27 && !isCovered; ++n) {
      const auto found = grid.find(key(cell + Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (found == grid.end()) continue;
      isCovered = std::any_of(found->second.begin(), found->second.end(),
                              [&](std::size_t k) { return (kept[k] - p).norm() < apart; });
    }
    if (isCovered) continue;
    grid[key(cell)].push_back(kept.size());
    kept.push_back(p);
  }
  return kept;
}

}  // namespace lumen::convert
