// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_section.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/wall_ellipse.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Least strength of a wall, as a share of the strength of the node's wall.
constexpr double kLeastStrengthShare = 0.3;
/// Shares of the distance to a wall at which a ray must be in the lumen.
constexpr double kLumenShares[] = {0.4, 0.6, 0.8};
/// Number of times that the section is moved to its own middle, and the largest distance of all
/// these moves, in radii.
constexpr int kMoves = 3;
constexpr double kSectionAsideRadii = 0.75;
/// Least number of points that a section must explain, relative to the cylinder.
constexpr double kMorePoints = 1.25;

/// Points that rays from a node's centre meet: in its height, at a wall, with lumen before them.
std::vector<WallPlace> placesAround(TrackRun& run, const TrackedNode& node, const Vector3d& axis) {
  const TrackContext& context = run.context;
  const VolumeGeometry& geometry = context.volume.geometry();
  const double sign = context.options.dark ? -1.0 : 1.0;
  const auto valueAt = [&](const Vector3d& p) {
    return sign * context.volume.sample(geometry.indexFromWorld(p));
  };
  std::vector<double> levels;
  for (const formats::Vec3f& p : node.points) levels.push_back(valueAt(toEigen(p)));
  const double level = median(std::move(levels));
  Candidates& points = run.workspace.candidates;
  run.workspace.caster.cast(node.centre, kRayRadii * node.radius, points);
  std::vector<WallPlace> places;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Vector3d offset = points.offset(i);
    if (std::abs(offset.dot(axis)) > 0.5 * node.height) continue;
    if (points.strength[i] < kLeastStrengthShare * node.strength) continue;
    const bool isLumen =
        std::all_of(std::begin(kLumenShares), std::end(kLumenShares),
                    [&](double share) { return valueAt(node.centre + share * offset) > level; });
    if (!isLumen) continue;
    places.push_back({node.centre + offset});
  }
  return places;
}

/// The chord from the nearest node before a node to the nearest behind it that are a radius away,
/// or to the end: nearer nodes show where a fit leant to rather than where the vessel runs.
Vector3d chordAt(const std::vector<TrackedNode>& nodes, std::size_t n) {
  const auto isFar = [&](std::size_t i) {
    return (nodes[i].centre - nodes[n].centre).norm() >= nodes[n].radius;
  };
  std::size_t before = n, behind = n;
  while (before > 0 && !isFar(before)) --before;
  while (behind + 1 < nodes.size() && !isFar(behind)) ++behind;
  return nodes[behind].centre - nodes[before].centre;
}

/// The number of sectors in which the node's own wall points lie.
std::size_t countSectors(const TrackedNode& node, const Vector3d& axis) {
  std::vector<WallPlace> places;
  for (const formats::Vec3f& p : node.points) places.push_back({toEigen(p)});
  measureAbout(node.centre, axis, places);
  return sectorsWith(places);
}

/// A node with a section about `axis` (unit) as its wall; empty where it keeps its cylinder.
std::optional<TrackedNode> fitSection(TrackRun& run, const TrackedNode& node,
                                      const Vector3d& axis) {
  std::vector<WallPlace> places = placesAround(run, node, axis);
  if (places.size() < kFewestCandidates) return std::nullopt;
  const auto [u, v] = planeBasis(axis);
  Vector3d centre = node.centre;
  WallEllipse section;
  for (int move = 0; move < kMoves; ++move) {
    measureAbout(centre, axis, places);
    section = fitEllipse(places, node.radius);
    if (!section.isValid()) return std::nullopt;
    centre += section.middle()[0] * u + section.middle()[1] * v;
    if ((centre - node.centre).norm() > kSectionAsideRadii * node.radius) return std::nullopt;
  }
  std::erase_if(places, [&](const WallPlace& p) {
    const double wall = section.wallAt(p);
    return std::abs(p.distance - wall) > run.context.search.band * wall;
  });
  const std::size_t sectors = sectorsWith(places);
  if (sectors < kLeastSectors || sectors < countSectors(node, axis) ||
      static_cast<double>(places.size()) < kMorePoints * static_cast<double>(node.points.size()))
    return std::nullopt;
  TrackedNode out = node;
  out.direction = axis;
  out.centre = centre;
  out.radius = section.radius();
  out.points.clear();
  for (const WallPlace& p : places) out.points.push_back(toVec3f(p.position));
  return out;
}

}  // namespace

void fitSections(TrackRun& run, std::vector<TrackedNode>& nodes) {
  std::vector<TrackedNode> out = nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const TrackedNode& node = nodes[i];
    if (node.origin != formats::NodeOrigin::Measured || node.points.empty() ||
        node.inlierRate >= run.context.options.inlierRate)
      continue;
    const Vector3d chord = chordAt(nodes, i);
    if (!(chord.norm() > 0)) continue;
    if (auto fitted = fitSection(run, node, chord.normalized())) out[i] = std::move(*fitted);
  }
  nodes = std::move(out);
}

}  // namespace lumen::convert
