// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/sac_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Of the least ball's radius: half of the width of a way that leads on within the sac.
constexpr double kHalfWay = 0.25;
/// Voxels: how far beyond what a ball of half a way's width reaches the sac still goes, for corners.
constexpr double kCorner = 1.5;
/// Voxels in a box: beyond, a radius was mistyped.
constexpr std::size_t kMostInBox = std::size_t{1} << 24;
/// Voxels: a profile across the wall, from inside to outside, and the spacing of its samples.
constexpr double kInward = 2.0, kOutward = 2.5, kProfileStep = 0.125;
constexpr auto kProfile = static_cast<std::size_t>((kInward + kOutward) / kProfileStep) + 1;
/// Samples before and behind a place whose difference is the fall there: half a voxel apart.
constexpr std::size_t kHalfFall = 2;

/// Voxels between two looks at whether the user has cancelled, less one.
constexpr std::size_t kOften = 4095;

constexpr double kNoPlace = std::numeric_limits<double>::infinity();

const std::array<Vector3i, 6> kFaces = {Vector3i(-1, 0, 0), Vector3i(1, 0, 0),  Vector3i(0, -1, 0),
                                        Vector3i(0, 1, 0),  Vector3i(0, 0, -1), Vector3i(0, 0, 1)};

/// Squared distances along one line to the nearest place, f being the squared distance that each
/// place has already (P. Felzenszwalb, D. Huttenlocher, "Distance transforms of sampled functions",
/// 2012).
class LineTransform {
public:
  void apply(std::vector<double>& f, double spacing) {
    m_parabola.clear();
    m_from.clear();
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (f[i] == kNoPlace) continue;
      double from = -kNoPlace;
      while (!m_parabola.empty()) {
        from = meeting(f, m_parabola.back(), i, spacing);
        if (from > m_from.back()) break;
        m_parabola.pop_back();
        m_from.pop_back();
        from = -kNoPlace;
      }
      m_parabola.push_back(i);
      m_from.push_back(from);
    }
    if (m_parabola.empty()) return;
    m_out.resize(f.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      while (k + 1 < m_parabola.size() && m_from[k + 1] < static_cast<double>(i)) ++k;
      const double along = (static_cast<double>(i) - static_cast<double>(m_parabola[k])) * spacing;
      m_out[i] = along * along + f[m_parabola[k]];
    }
    std::swap(f, m_out);
  }

private:
  /// Where the parabola of a later place takes over from that of an earlier one.
  static double meeting(const std::vector<double>& f, std::size_t a, std::size_t b,
                        double spacing) {
    const double p = static_cast<double>(a), q = static_cast<double>(b), s2 = spacing * spacing;
    return ((f[b] / s2 + q * q) - (f[a] / s2 + p * p)) / (2 * (q - p));
  }
  std::vector<std::size_t> m_parabola;
  std::vector<double> m_from, m_out;
};

/// mm from each voxel of a box to the nearest one whose mark is `target`.
std::vector<float> distanceTo(const TrackContext& context, const VoxelBox& box,
                              const std::vector<std::uint8_t>& mark, std::uint8_t target) {
  const Vector3d& spacing = context.volume.geometry().spacing;
  std::vector<double> squared(mark.size());
  for (std::size_t i = 0; i < mark.size(); ++i) squared[i] = mark[i] == target ? 0 : kNoPlace;
  LineTransform transform;
  std::vector<double> line;
  for (int axis = 0; axis < 3; ++axis) {
    Vector3i across = box.size;
    across[axis] = 1;
    Vector3i unit = Vector3i::Zero();
    unit[axis] = 1;
    const std::size_t stride = box.place(unit);
    const VoxelBox lines{Vector3i::Zero(), across};
    line.resize(static_cast<std::size_t>(box.size[axis]));
    for (std::size_t l = 0; l < lines.count(); ++l) {
      if ((l & kOften) == 0) context.progress.check();
      const std::size_t start = box.place(lines.cell(l));
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = squared[start + i * stride];
      transform.apply(line, spacing[axis]);
      for (std::size_t i = 0; i < line.size(); ++i) squared[start + i * stride] = line[i];
    }
  }
  std::vector<float> out(squared.size());
  std::transform(squared.begin(), squared.end(), out.begin(),
                 [](double d) { return static_cast<float>(std::sqrt(d)); });
  return out;
}

/// Marks with `reached` what is joined to the places in `queue` by faces of voxels marked `open`.
void flood(const VoxelBox& box, std::vector<std::uint8_t>& mark, std::uint8_t open,
           std::uint8_t reached, std::vector<std::size_t> queue) {
  std::erase_if(queue, [&](std::size_t place) { return mark[place] != open; });
  for (const std::size_t place : queue) mark[place] = reached;
  while (!queue.empty()) {
    const Vector3i cell = box.cell(queue.back());
    queue.pop_back();
    for (const Vector3i& step : kFaces) {
      const Vector3i next = cell + step;
      if (!box.holds(next)) continue;
      const std::size_t place = box.place(next);
      if (mark[place] != open) continue;
      mark[place] = reached;
      queue.push_back(place);
    }
  }
}

VoxelBox boxAround(const VolumeGeometry& geometry, std::span<const SacBall> balls) {
  Vector3d low = Vector3d::Constant(kNoPlace), high = Vector3d::Constant(-kNoPlace);
  for (const SacBall& ball : balls) {
    const Vector3d at = geometry.indexFromWorld(ball.centre);
    const Vector3d half = (kSacReach * ball.radius / geometry.spacing.array()).matrix();
    low = low.cwiseMin(at - half);
    high = high.cwiseMax(at + half);
  }
  VoxelBox box;
  for (int a = 0; a < 3; ++a) {
    const double last = geometry.size[static_cast<std::size_t>(a)] - 1;
    box.low[a] = static_cast<int>(std::clamp(std::floor(low[a]), 0.0, last));
    box.size[a] = static_cast<int>(std::clamp(std::ceil(high[a]), 0.0, last)) - box.low[a] + 1;
  }
  return box;
}

/// 1 where the volume is lumen, holes within it included, else 0.
std::vector<std::uint8_t> lumenIn(const TrackContext& context, double wallLevel,
                                  const VoxelBox& box) {
  constexpr std::uint8_t kDark = 0, kLumen = 1, kOpen = 2;
  const float sign = context.options.dark ? -1.0F : 1.0F;
  std::vector<std::uint8_t> mark(box.count(), kDark);
  std::vector<float> row(static_cast<std::size_t>(box.size.x()));
  for (std::size_t start = 0; start < mark.size(); start += row.size()) {
    context.progress.check();
    context.volume.sampleLine(box.index(box.cell(start)), Vector3d::UnitX(), row);
    for (std::size_t i = 0; i < row.size(); ++i)
      if (sign * (row[i] - static_cast<float>(wallLevel)) > 0) mark[start + i] = kLumen;
  }
  std::vector<std::size_t> rim;
  for (std::size_t place = 0; place < mark.size(); ++place) {
    const Vector3i cell = box.cell(place);
    if ((cell.array() == 0).any() || (cell.array() == box.size.array() - 1).any())
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
    const VoxelBox near = boxAround(geometry, {&half, 1});
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < near.count(); ++i) {
      const Vector3d index = near.index(near.cell(i));
      const auto place = region.box.at(index);
      if (!place || (geometry.worldFromIndex(index) - ball.centre).norm() > 0.5 * ball.radius)
        continue;
      if (!best || region.depth[*place] > region.depth[*best]) best = place;
    }
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
Vector3d outsideOf(const SacRegion& region, const Vector3i& cell) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3i& step : kFaces) {
    const Vector3i next = cell + step;
    if (region.box.holds(next) && region.depth[region.box.place(next)] == 0)
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
void addWall(const TrackContext& context, const Vector3d& at, const Vector3d& way,
             std::vector<float>& values, SacWall& wall) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const float sign = context.options.dark ? -1.0F : 1.0F;
  context.volume.sampleLine(at - kInward * way, kProfileStep * way, values);
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
  wall.points.push_back(geometry.worldFromIndex(at + along * way));
  wall.strength.push_back(static_cast<double>(strongest) /
                          (2 * kHalfFall * kProfileStep * geometry.voxelSize()));
}

}  // namespace

std::size_t VoxelBox::count() const {
  return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
}

std::size_t VoxelBox::place(const Vector3i& cell) const {
  return (std::size_t(cell[2]) * std::size_t(size[1]) + std::size_t(cell[1])) *
             std::size_t(size[0]) +
         std::size_t(cell[0]);
}

Vector3i VoxelBox::cell(std::size_t place) const {
  const std::size_t row = place / std::size_t(size[0]);
  return {static_cast<int>(place % std::size_t(size[0])),
          static_cast<int>(row % std::size_t(size[1])),
          static_cast<int>(row / std::size_t(size[1]))};
}

std::optional<std::size_t> VoxelBox::at(const Vector3d& index) const {
  Vector3i cell;
  for (int a = 0; a < 3; ++a) {
    const double nearest = std::round(index[a]) - low[a];
    if (!(nearest >= 0 && nearest < size[a])) return {};
    cell[a] = static_cast<int>(nearest);
  }
  return place(cell);
}

double leastPassage(std::span<const SacBall> balls) {
  double least = kNoPlace;
  for (const SacBall& ball : balls) least = std::min(least, ball.radius);
  return kHalfWay * least;
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
  region.depth = distanceTo(context, region.box, region.isSac, 0);
  const double coarsest = geometry.spacing.maxCoeff();
  const double half = std::max(leastPassage(balls), coarsest);
  std::vector<std::uint8_t> core(region.isSac.size(), kNone);
  for (std::size_t i = 0; i < core.size(); ++i) {
    if ((i & kOften) == 0) context.progress.check();
    if (!region.isSac[i]) continue;
    const Vector3d p = geometry.worldFromIndex(region.box.index(region.box.cell(i)));
    region.isSac[i] = isInReach(balls, p) && !inVessel(p);
    if (region.isSac[i] && region.depth[i] > half) core[i] = kDeep;
  }
  flood(region.box, core, kDeep, kJoined, deepestIn(geometry, region, balls));
  const auto fromCore = distanceTo(context, region.box, core, kJoined);
  bool isEmpty = true;
  for (std::size_t i = 0; i < core.size(); ++i) {
    region.isSac[i] = region.isSac[i] && fromCore[i] < half + kCorner * coarsest;
    isEmpty = isEmpty && !region.isSac[i];
  }
  if (isEmpty) return {};
  return region;
}

SacWall wallOf(const TrackContext& context, const SacRegion& region) {
  SacWall wall;
  std::vector<float> values(kProfile);
  for (std::size_t i = 0; i < region.isSac.size(); ++i) {
    if ((i & kOften) == 0) context.progress.check();
    if (!region.isSac[i]) continue;
    const Vector3i cell = region.box.cell(i);
    const Vector3d outside = outsideOf(region, cell);
    if ((outside.array() == 0).all()) continue;
    const Vector3d at = region.box.index(cell), way = downhill(context, at);
    if (way.dot(outside) > 0) addWall(context, at, way, values, wall);
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
