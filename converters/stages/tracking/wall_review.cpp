// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_review.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/cylinders/wall_ellipse.h"
#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/path_rules.h"

namespace lumen::convert {

namespace {

using Eigen::Vector3d;

/// Length of the vessel on either side from which the expected radius is taken, in radii of the
/// node. A bulge that is longer than it is wide is therefore expected.
constexpr double kSideRadii = 4;
/// The fewest nodes on a side.
constexpr std::size_t kFewestNodesBeside = 3;
/// First stream of random numbers, far from those of tracking.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 32;

/// The median radius of the nodes up to `reach` mm along the vessel to one side; empty if they are
/// too few.
std::optional<double> radiusBeside(const std::vector<TrackedNode>& nodes, std::size_t from,
                                   bool ahead, double reach) {
  std::vector<double> radii;
  double length = 0;
  for (std::size_t i = from; ahead ? i + 1 < nodes.size() : i > 0;) {
    const std::size_t next = ahead ? i + 1 : i - 1;
    length += (nodes[next].centre - nodes[i].centre).norm();
    if (length > reach) break;
    i = next;
    if (nodes[i].origin == formats::NodeOrigin::Measured) radii.push_back(nodes[i].radius);
  }
  if (radii.size() < kFewestNodesBeside) return std::nullopt;
  return median(std::move(radii));
}

/// The radius that the two sides let expect of a swollen node; empty if it is not swollen.
std::optional<double> expectedRadius(const TrackContext& context,
                                     const std::vector<TrackedNode>& nodes, std::size_t n) {
  const TrackedNode& node = nodes[n];
  if (node.origin != formats::NodeOrigin::Measured || node.inlierRate >= context.options.inlierRate)
    return std::nullopt;
  const auto before = radiusBeside(nodes, n, false, kSideRadii * node.radius);
  const auto after = radiusBeside(nodes, n, true, kSideRadii * node.radius);
  if (!before || !after || node.radius <= kWidest * std::max(*before, *after)) return std::nullopt;
  return 0.5 * (*before + *after);
}

/// Fits the swollen nodes [first, end) between two trusted ones anew, or bridges them, along the
/// line between those two.
void replaceRun(TrackRun& run, std::vector<TrackedNode>& nodes, std::size_t first, std::size_t end,
                const std::vector<double>& expected) {
  const TrackedNode from = nodes[first - 1], to = nodes[end];
  const Vector3d chord = to.centre - from.centre;
  if (!(chord.norm() > 0)) return;
  const Vector3d direction = chord.normalized();
  const double step = chord.norm() / static_cast<double>(end - first + 1);
  for (std::size_t n = first; n < end; ++n) {
    const Vector3d place = from.centre + step * static_cast<double>(n - first + 1) * direction;
    const double radius = expected[n];
    NodeFit fit = fitNode(run, {place, direction, radius, true, 0.5 * step},
                          leastInlierRate(run.context.options));
    if (fit.node && fit.node->radius <= kWidest * radius &&
        (fit.node->centre - place).norm() <= radius) {
      nodes[n] = std::move(*fit.node);
      continue;
    }
    TrackedNode bridge;
    bridge.origin = formats::NodeOrigin::Bridged;
    bridge.centre = place;
    bridge.direction = direction;
    bridge.radius = radius;
    bridge.height = 2 * step;
    nodes[n] = std::move(bridge);
  }
}

void replaceSwollen(TrackRun& run, std::vector<TrackedNode>& nodes) {
  std::vector<double> expected;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    expected.push_back(expectedRadius(run.context, nodes, n).value_or(0));
  for (std::size_t n = 0; n < nodes.size();) {
    std::size_t end = n;
    while (end < nodes.size() && expected[end] > 0) ++end;
    // a side has nodes, so no run begins or ends the vessel
    if (end > n) replaceRun(run, nodes, n, end, expected);
    n = end + 1;
  }
}

}  // namespace

void reviewWalls(const TrackContext& context, TrackedTree& tree) {
  tbb::parallel_for(tree.known, tree.branches.size(), [&](std::size_t i) {
    if (!tree.isVessel(i)) return;
    TrackRun run(context, Random(context.options.seed, kFirstStream + i));
    replaceSwollen(run, tree.branches[i].nodes);
    fitSections(run, tree.branches[i].nodes);
  });
}

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

namespace {

using Eigen::Vector3d;

/// Extent of the sampled inside, in radii. The band of inliers ends at nine tenths.
constexpr double kInside = 0.8;
/// Sections along the axis, rings of a section, and samples of the first ring, by which number each
/// ring exceeds the last: every sample represents the same area.
constexpr int kSections = 3, kRings = 3, kOnFirstRing = 6;
/// Place of the outer sections, in half heights. Farther out a bend leaves the cylinder.
constexpr double kOuterSection = 0.5;
/// Largest dark share of the inside of one vessel. A circle around the longer axis of an ellipse of
/// axes 3:2, which is a vessel, is dark by a third; a circle that two touching discs of equal size
/// share with the gap between them, by a half.
constexpr double kMostDark = 0.28;
/// The most steps to the middle of a lumen, and the reach of a sample's attraction, in radii.
constexpr int kShifts = 8;
constexpr double kAttraction = 0.4;

struct Sample {
  Vector3d position;
  double value;
};

/// The level halfway down the wall, brighter being more.
double wallLevel(const BsplineVolume& volume, const TrackedNode& node, double sign) {
  std::vector<double> values;
  for (const formats::Vec3f& p : node.points) {
    const double value = sign * volume.sample(volume.geometry().indexFromWorld(toEigen(p)));
    if (!std::isnan(value)) values.push_back(value);
  }
  return values.empty() ? -std::numeric_limits<double>::infinity() : median(std::move(values));
}

/// Samples spread evenly over the inside; those outside of the volume are left out.
std::vector<Sample> sampleInside(const BsplineVolume& volume, const TrackedNode& node,
                                 double sign) {
  std::vector<Sample> samples;
  const auto [u, v] = planeBasis(node.direction);
  const auto add = [&](const Vector3d& position) {
    const double value = sign * volume.sample(volume.geometry().indexFromWorld(position));
    if (!std::isnan(value)) samples.push_back({position, value});
  };
  for (int s = 0; s < kSections; ++s) {
    const double along = kOuterSection * 0.5 * node.height * (2.0 * s / (kSections - 1) - 1.0);
    const Vector3d centre = node.centre + along * node.direction;
    add(centre);
    for (int ring = 1; ring <= kRings; ++ring) {
      const double r = kInside * node.radius * ring / (kRings + 0.5);
      const int count = kOnFirstRing * ring;
      for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        add(centre + r * (std::cos(angle) * u + std::sin(angle) * v));
      }
    }
  }
  return samples;
}

/// The middle of the bright samples around the one nearest to `guess`: where the mean of those near
/// it stays in place (mean shift; K. Fukunaga, L. Hostetler, 1975).
Vector3d findMiddle(const std::vector<Sample>& bright, const Vector3d& guess, double reach) {
  const auto nearer = [&](const Sample& a, const Sample& b) {
    return (a.position - guess).squaredNorm() < (b.position - guess).squaredNorm();
  };
  Vector3d at = std::min_element(bright.begin(), bright.end(), nearer)->position;
  for (int step = 0; step < kShifts; ++step) {
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    for (const Sample& sample : bright) {
      const double weight = std::exp(-(sample.position - at).squaredNorm() / (reach * reach));
      sum += weight * sample.position;
      weights += weight;
    }
    at = sum / weights;
  }
  return at;
}

}  // namespace

WallSupport wallSupport(const BsplineVolume& volume, const TrackedNode& node, const Vector3d& guess,
                        bool dark) {
  const double sign = dark ? -1.0 : 1.0;
  WallSupport support{0, node.centre, node.radius};
  if (node.points.empty()) return support;
  const double level = wallLevel(volume, node, sign);
  std::vector<Sample> samples = sampleInside(volume, node, sign);
  const std::size_t all = samples.size();
  std::erase_if(samples, [&](const Sample& s) { return s.value < level; });
  if (all == 0) return support;
  const double bright = static_cast<double>(samples.size()) / static_cast<double>(all);
  support.dark = 1.0 - bright;
  support.radius = node.radius * std::sqrt(bright);
  if (!samples.empty()) support.middle = findMiddle(samples, guess, kAttraction * node.radius);
  return support;
}

bool isSupported(const WallSupport& support) {
  return support.dark <= kMostDark;
}

}  // namespace lumen::convert
