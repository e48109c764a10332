// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/corrections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/cylinders/wall_ellipse.h"
#include "converters/voxels/profile_edge.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// The most nodes that are measured, to bound the time, and the fewest for a meaningful median.
constexpr std::size_t kMostNodes = 256, kFewestNodes = 8;
/// Least radius whose walls are measured; a voxel if there are too few. Wider walls are flatter, and
/// less of the far wall shows in their profiles.
constexpr double kDrawnVoxels = 3.0;
/// The fewest wall points of a node that is measured: with fewer, its profile is mostly noise.
constexpr std::size_t kFewestPoints = 32;
/// Reach of a profile to either side of the wall, and the spacing of its samples.
constexpr double kReachVoxels = 4.0, kSpacingVoxels = 0.1;
constexpr int kSamples = 2 * static_cast<int>(kReachVoxels / kSpacingVoxels) + 1;
/// The steepest fall is searched for within one N-th of a profile's samples on either side.
constexpr std::size_t kNearWallFraction = 8;
/// Distance from the wall within which the levels of lumen and background are taken. Farther out
/// other vessels begin.
constexpr double kLevelReachVoxels = 2.5;
/// A half level nearer to the steepest fall than this cannot be distinguished from it.
constexpr double kLopsidedVoxels = 0.05;
/// The largest move of a wall to the half level, in radii.
constexpr double kLopsidedRadii = 0.1;

/// The last partial denominator of the continued fraction: it has converged to all digits for the
/// arguments that occur, w < (q + 1)^2 with q <= kNearlyFlat.
constexpr int kLastDenominator = 120;
/// (seen/sigma)^2 beyond which two terms of the expansion for flat walls are exact to 1e-5.
constexpr double kNearlyFlat = 50;
/// The least radius to which a ball is corrected, as a share of the radius seen, as for the
/// cylinder.
constexpr double kLeastShare = 0.5;

/// z I0(z)/I1(z) - 2 as a function of w = z^2, by the continued fraction of Bessel functions'
/// ratios (Abramowitz and Stegun, 9.1.73, for imaginary arguments).
double besselTerm(double w) {
  double tail = 0;
  for (int k = kLastDenominator; k >= 4; k -= 2) tail = w / (k + tail);
  return tail;
}

/// A node's wall points about its axis, each with the distance of the wall there: of the ellipse
/// through them, and of the cylinder where they show no ellipse.
std::vector<std::pair<WallPlace, double>> wallsAround(const TrackedNode& node) {
  std::vector<WallPlace> places;
  for (const formats::Vec3f& p : node.points) places.push_back({toEigen(p)});
  measureAbout(node.centre, node.direction, places);
  const WallEllipse ellipse = fitEllipse(places, node.radius);
  const bool isEllipse = ellipse.isValid() && sectorsWith(places) >= kLeastSectors;
  std::vector<std::pair<WallPlace, double>> walls;
  for (const WallPlace& place : places) {
    const double wall = isEllipse ? ellipse.wallAt(place) : node.radius;
    if (std::isfinite(wall)) walls.emplace_back(place, wall);
  }
  return walls;
}

/// The mean over a node's wall points of the intensity on the line from its axis through the point,
/// at distances wall - kReachVoxels .. wall + kReachVoxels voxels. Lined up by a smooth wall, not
/// by the points: those follow the noise, and their mean would be steeper than the wall. Lined up
/// by a circle, walls that are not round would seem blurred. Empty without a point.
std::vector<double> meanProfile(const BsplineVolume& volume, const TrackedNode& node) {
  const VolumeGeometry& geometry = volume.geometry();
  const double voxel = geometry.voxelSize();
  std::vector<double> sum(kSamples, 0.0);
  std::vector<float> values(kSamples);
  const auto walls = wallsAround(node);
  for (const auto& [place, wall] : walls) {
    const Vector3d offset = place.position - node.centre;
    const double along = offset.dot(node.direction);
    const Vector3d outward = (offset - along * node.direction).normalized();
    const Vector3d start =
        node.centre + along * node.direction + (wall - kReachVoxels * voxel) * outward;
    const Vector3d step = (geometry.direction.transpose() * outward * (kSpacingVoxels * voxel))
                              .cwiseQuotient(geometry.spacing);
    volume.sampleLine(geometry.indexFromWorld(start), step, values);
    for (std::size_t i = 0; i < values.size(); ++i) sum[i] += static_cast<double>(values[i]);
  }
  if (walls.empty()) return {};
  for (double& value : sum) value /= static_cast<double>(walls.size());
  return sum;
}

/// The fall of a profile around its middle, in samples; brighter inside.
struct Fall {
  double width = 0;      ///< in full at half height; 0 if it does not fall to half on either side
  double halfLevel = 0;  ///< from the steepest place outward to the half level
};

/// The distance from the place `peak`, refined by a parabola through the falls around it, to the
/// place where the profile passes halfway between the greatest mean over a voxel before it and the
/// least one behind; 0 if it does not.
double findHalfLevel(const std::vector<double>& profile, const std::vector<double>& fall,
                     std::size_t peak) {
  const auto reach = static_cast<std::size_t>(kLevelReachVoxels / kSpacingVoxels);
  const auto box = static_cast<std::size_t>(1.0 / kSpacingVoxels);
  const std::size_t half = box / 2, first = peak - std::min(peak, reach);
  const auto meanAround = [&](std::size_t i) {
    return std::accumulate(profile.begin() + static_cast<std::ptrdiff_t>(i - half),
                           profile.begin() + static_cast<std::ptrdiff_t>(i + half), 0.0) /
           static_cast<double>(2 * half);
  };
  double inside = meanAround(peak - half), outside = meanAround(peak + half);
  for (std::size_t i = std::max(first, half); i + half < peak; ++i)
    inside = std::max(inside, meanAround(i));
  for (std::size_t i = peak + half; i <= peak + reach && i + half < profile.size(); ++i)
    outside = std::min(outside, meanAround(i));
  const double level = 0.5 * (inside + outside);
  const double bend = fall[peak - 1] - 2 * fall[peak] + fall[peak + 1];
  const double steepest =
      static_cast<double>(peak) + (bend < 0 ? 0.5 * (fall[peak - 1] - fall[peak + 1]) / bend : 0);
  std::size_t at = peak;
  while (at > first && profile[at] < level) --at;
  while (at + 1 < profile.size() && at < peak + reach && profile[at + 1] >= level) ++at;
  if (at + 1 >= profile.size() || profile[at] < level || profile[at + 1] >= level) return 0;
  return static_cast<double>(at) + (profile[at] - level) / (profile[at] - profile[at + 1]) -
         steepest;
}

Fall findFall(std::vector<double> profile, double sign) {
  for (double& value : profile) value *= sign;
  const std::size_t n = profile.size();
  std::vector<double> fall(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) fall[i] = profile[i - 1] - profile[i + 1];
  const FallWidth steepest = fallWidth(fall, n / kNearWallFraction);
  if (steepest.width == 0) return {};
  return {steepest.width, findHalfLevel(profile, fall, steepest.at)};
}

/// Standard deviation of the blur under which a disc falls fastest at `seen` from its centre, by a
/// curve that is `width` wide at half its height; 0 if the disc is too narrow to show it. For wide
/// discs 1/s^2 = 1/g^2 + 1/(2 seen^2), where g is the Gaussian's of that width; below, a table of
/// the closed form (see cylinderRadius) for radii of 1.5, 1.75, 2, 2.5 and 3 standard deviations.
double blurSpread(double seen, double width) {
  struct Entry {
    double ratio, share;
  };
  constexpr std::array<Entry, 5> kTable = {
      {{0.6680, 0.4808}, {0.7112, 0.4502}, {0.7747, 0.4284}, {0.9565, 0.4125}, {1.1749, 0.4135}}};
  const double ratio = seen / width;
  if (ratio < kTable.front().ratio) return 0;
  for (std::size_t i = 1; i < kTable.size(); ++i) {
    const auto& [low, high] = std::pair(kTable[i - 1], kTable[i]);
    if (ratio > high.ratio) continue;
    const double t = (ratio - low.ratio) / (high.ratio - low.ratio);
    return width * (low.share + t * (high.share - low.share));
  }
  const double gaussian = width / kWidthAtHalfHeight;
  return 1.0 / std::sqrt(1.0 / (gaussian * gaussian) + 0.5 / (seen * seen));
}

/// The profile, `step` mm from sample to sample, of the disc that a blur of `sigma` makes fall
/// fastest at `seen` from its centre. Its fall is the blurred edge, summed around it. Narrow discs
/// have their half level elsewhere by themselves.
std::vector<double> blurredDisc(double seen, double sigma, double step) {
  constexpr int kParts = 64;
  const double radius = cylinderRadius(seen, sigma), s2 = sigma * sigma;
  std::vector<double> profile(kSamples, 0.0);
  double sum = 0;
  for (std::size_t i = profile.size(); i-- > 0;) {
    const double r = seen + (static_cast<double>(i) + 0.5 - 0.5 * (kSamples - 1)) * step;
    double fall = 0;
    for (int part = 0; part < kParts; ++part) {
      const double c = std::cos(2 * std::numbers::pi * part / kParts);
      fall += c * std::exp((2 * r * radius * c - r * r - radius * radius) / (2 * s2));
    }
    sum += fall * radius * step / (s2 * kParts);
    profile[i] = sum;
  }
  return profile;
}

/// The nodes whose walls are measured: the wide ones, or the widest ones available, spread evenly.
std::vector<const TrackedNode*> widestNodes(std::span<const TrackedBranch* const> vessels,
                                            double voxel) {
  std::vector<const TrackedNode*> wide;
  for (const double voxels : {kDrawnVoxels, 1.0}) {
    wide.clear();
    for (const TrackedBranch* branch : vessels)
      for (const TrackedNode& node : branch->nodes)
        if (node.radius >= voxels * voxel && node.points.size() >= kFewestPoints)
          wide.push_back(&node);
    if (wide.size() >= kFewestNodes) break;
  }
  if (wide.size() <= kMostNodes) return wide;
  std::vector<const TrackedNode*> even;
  for (std::size_t i = 0; i < kMostNodes; ++i) even.push_back(wide[i * wide.size() / kMostNodes]);
  return even;
}

/// The largest shift of a centre, in radii. Vessels whose bends require more are bent too sharply
/// for a circle to determine the shift.
constexpr double kLargestShiftRadii = 0.1;

/// The curvature at node `n`, 1/mm, towards the middle of the bend; zero where the chain is too
/// short.
Vector3d curvatureAt(const std::vector<TrackedNode>& nodes, std::size_t n) {
  const Vector3d& centre = nodes[n].centre;
  const auto isFar = [&](const TrackedNode& node) {
    return (node.centre - centre).norm() >= nodes[n].height;
  };
  const auto at = nodes.begin() + static_cast<std::ptrdiff_t>(n);
  const auto ahead = std::find_if(at, nodes.end(), isFar);
  const auto behind = std::find_if(std::make_reverse_iterator(at), nodes.rend(), isFar);
  if (ahead == nodes.end() || behind == nodes.rend()) return Vector3d::Zero();
  const Vector3d on = ahead->centre - centre, from = centre - behind->centre;
  return 2.0 / (on.norm() + from.norm()) * (on.normalized() - from.normalized());
}

}  // namespace

double cylinderRadius(double seen, double sigma) {
  if (!(sigma > 0)) return seen;
  const double q = seen * seen / (sigma * sigma);
  if (q > kNearlyFlat) return seen * (1.0 + (0.5 - 0.375 / q) / q);
  double low = 0.25 * q * q, high = (q + 1) * (q + 1);
  for (double middle = 0.5 * (low + high); low < middle && middle < high;
       middle = 0.5 * (low + high))
    (besselTerm(middle) < q - 1 ? low : high) = middle;
  return seen * std::sqrt(high) / q;
}

double ballRadius(double seen, double sigma) {
  // both principal curvatures displace the wall by s^2/(2R)
  return std::max(2.0 * cylinderRadius(seen, sigma) - seen, kLeastShare * seen);
}

std::optional<WallShape> measureWalls(const BsplineVolume& volume,
                                      std::span<const TrackedBranch* const> vessels, bool dark) {
  const double voxel = volume.geometry().voxelSize();
  std::vector<double> spreads, halfLevels;
  for (const TrackedNode* node : widestNodes(vessels, voxel)) {
    const std::vector<double> profile = meanProfile(volume, *node);
    if (profile.empty()) continue;
    const Fall fall = findFall(profile, dark ? -1.0 : 1.0);
    if (fall.width == 0) continue;
    const double spread = blurSpread(node->radius, fall.width * kSpacingVoxels * voxel);
    if (!(spread > 0)) continue;
    spreads.push_back(spread);
    const Fall even = findFall(blurredDisc(node->radius, spread, kSpacingVoxels * voxel), 1);
    halfLevels.push_back((fall.halfLevel - even.halfLevel) * kSpacingVoxels * voxel);
  }
  if (spreads.size() < kFewestNodes) return std::nullopt;
  const double halfLevel = median(std::move(halfLevels));
  return WallShape{median(std::move(spreads)),
                   std::abs(halfLevel) > kLopsidedVoxels * voxel ? halfLevel : 0.0};
}

void correctWalls(TrackedBranch& branch, formats::BranchKind kind, const WallShape& shape) {
  for (TrackedNode& node : branch.nodes) {
    const bool vessel = kind == formats::BranchKind::Vessel;
    const double most = kLopsidedRadii * node.radius;
    const double seen = node.radius + std::clamp(shape.halfLevel, -most, most);
    const double radius =
        vessel ? cylinderRadius(seen, shape.pointSpread) : ballRadius(seen, shape.pointSpread);
    for (formats::Vec3f& p : node.points) {
      Vector3d outward = toEigen(p) - node.centre;
      if (vessel) outward -= outward.dot(node.direction) * node.direction;
      const Eigen::Vector3f shift = ((radius - node.radius) * outward.normalized()).cast<float>();
      p.x += shift.x();
      p.y += shift.y();
      p.z += shift.z();
    }
    node.radius = radius;
  }
}

void correctBends(std::vector<TrackedNode>& nodes) {
  std::vector<Vector3d> shifts;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Vector3d shift = -0.5 * nodes[n].meanSquareAlong * curvatureAt(nodes, n);
    const double most = kLargestShiftRadii * nodes[n].radius;
    if (shift.norm() > most) shift *= most / shift.norm();
    shifts.push_back(shift);
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n].centre += shifts[n];
}

}  // namespace lumen::convert
