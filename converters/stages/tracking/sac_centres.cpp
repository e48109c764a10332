// SPDX-License-Identifier: Apache-2.0
// Declared in sac_walls.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "converters/stages/tracking/sac_walls.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Radii of the greatest ball around a centre: wall that is farther away is another part's, and how
/// near the centre of that part comes to it.
constexpr double kCover = 2, kNearby = 1.25;
/// The most centres that are added to one sac, and the fewest points of the wall that each must be
/// nearest to, by power: a node without any would determine nothing.
constexpr std::size_t kMostCentres = 32, kFewestOwned = 20;
/// The most places that are examined, to bound the time.
constexpr std::size_t kMostTurns = 128;

constexpr double kUnseen = std::numeric_limits<double>::infinity();

double powerAt(const Vector3d& p, const SacBall& ball) {
  return (p - ball.centre).squaredNorm() - ball.radius * ball.radius;
}

class Cover {
public:
  Cover(const VolumeGeometry& geometry, const SacRegion& region)
      : m_geometry(geometry), m_region(region) {
    for (std::size_t i = 0; i < region.isSac.size(); ++i)
      if (region.isSac[i]) m_inside.push_back(i);
  }

  /// The wall lies half a voxel before the nearest voxel outside.
  [[nodiscard]] double radiusOf(float depth) const {
    return static_cast<double>(depth) - 0.5 * m_geometry.voxelSize();
  }

  /// The greatest ball that reaches a place on the wall.
  [[nodiscard]] std::optional<SacBall> greatestFor(const Vector3d& wall, double least) const {
    std::optional<SacBall> best;
    for (const std::size_t i : m_inside) {
      const double radius = radiusOf(m_region.depth[i]);
      if (radius < (best ? best->radius : least) || (best && radius == best->radius)) continue;
      const Vector3d at = m_geometry.position(m_region.box.cell(i));
      if ((at - wall).norm() <= kNearby * radius) best = SacBall{at, radius};
    }
    return best;
  }

private:
  const VolumeGeometry& m_geometry;
  const SacRegion& m_region;
  std::vector<std::size_t> m_inside;
};

}  // namespace

std::vector<SacBall> furtherCentres(const TrackContext& context, const SacRegion& region,
                                    std::span<const Vector3d> wall, std::span<const SacBall> nodes,
                                    double least) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const Cover cover(geometry, region);
  std::vector<double> missed(wall.size(), kUnseen), power(wall.size(), kUnseen);
  const auto cast = [&](const SacBall& node, double inscribed) {
    for (std::size_t i = 0; i < wall.size(); ++i) {
      missed[i] = std::min(missed[i], (wall[i] - node.centre).norm() / inscribed);
      power[i] = std::min(power[i], powerAt(wall[i], node));
    }
  };
  for (const SacBall& node : nodes) {
    const auto depth = region.depthAt(geometry.indexFromWorld(node.centre));
    const double inscribed = depth ? cover.radiusOf(*depth) : 0;
    if (inscribed > 0) cast(node, inscribed);
  }
  std::vector<SacBall> centres;
  for (std::size_t turn = 0; turn < kMostTurns && centres.size() < kMostCentres; ++turn) {
    context.progress.check();
    const auto farthest = std::max_element(missed.begin(), missed.end());
    if (farthest == missed.end() || *farthest <= kCover) break;
    const Vector3d target = wall[static_cast<std::size_t>(farthest - missed.begin())];
    const auto ball = cover.greatestFor(target, least);
    std::size_t owned = 0;
    for (std::size_t i = 0; i < wall.size(); ++i) {
      if (ball) owned += powerAt(wall[i], *ball) < power[i];
      if ((wall[i] - target).norm() <= least) missed[i] = 0;  // looked at
    }
    if (owned < kFewestOwned) continue;
    cast(*ball, ball->radius);
    centres.push_back(*ball);
  }
  return centres;
}

bool isStraightPathInside(const VolumeGeometry& geometry, const SacRegion& region,
                          const Vector3d& a, const Vector3d& b) {
  const double half = 0.5 * geometry.spacing.minCoeff();
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / half)));
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = a + (b - a) * (static_cast<double>(i) / steps);
    const auto depth = region.depthAt(geometry.indexFromWorld(p));
    if (!depth || !(*depth > 0)) return false;
  }
  return true;
}

}  // namespace lumen::convert
