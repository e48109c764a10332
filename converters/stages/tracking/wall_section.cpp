// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_section.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Unknowns of a section's wall: see Section.
constexpr int kUnknowns = 7;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

/// Least strength of a wall, as a share of the strength of the node's wall.
constexpr double kLeastStrengthShare = 0.3;
/// Shares of the distance to a wall at which a ray must be in the lumen.
constexpr double kLumenShares[] = {0.4, 0.6, 0.8};
/// The most rounds of reweighting, and the relative change of the unknowns below which they end.
constexpr int kReweightings = 12;
constexpr double kSectionConverged = 1e-3;
/// Standard deviations beyond which a point has no weight (J. Tukey's biweight), and the ratio of a
/// standard deviation to the median of absolute residuals.
constexpr double kBiweightDeviations = 4.685, kDeviationOfMedian = 1.4826;
/// The largest ratio of a section's axes: a longer one is two vessels. Rays of kRayRadii show it in
/// full around a circle that fits between its sides.
constexpr double kLargestAxisRatio = 2.5;
/// Number of times that the section is moved to its own middle, and the largest distance of all
/// these moves, in radii.
constexpr int kMoves = 3;
constexpr double kSectionAsideRadii = 0.75;
/// Sectors around the axis, and the number of them that must have wall points.
constexpr std::size_t kSectors = 12, kLeastSectors = 8;
/// Least number of points that a section must explain, relative to the cylinder.
constexpr double kMorePoints = 1.25;

/// A wall point about an axis.
struct WallPlace {
  Vector3d position;
  double angle = 0, distance = 0;
  Unknowns row = Unknowns::Zero();  ///< factors of the section's unknowns; see Section
};

/// An ellipse about an axis, which widens or narrows along it: the inverse square of the distance
/// of its wall is linear in the sine and cosine of twice the angle; those of the angle itself move
/// it, to first order; the place along the axis and its square are a taper and a throat.
struct Section {
  Unknowns curve = Unknowns::Zero();

  static Unknowns rowAt(double angle, double along) {
    Unknowns row;
    row << 1.0, std::cos(angle), std::sin(angle), std::cos(2 * angle), std::sin(2 * angle), along,
        along * along;
    return row;
  }
  [[nodiscard]] double wallAt(const WallPlace& p) const {
    const double inverse = p.row.dot(curve);
    return inverse > 0 ? 1.0 / std::sqrt(inverse) : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double oblong() const { return std::hypot(curve[3], curve[4]); }
  [[nodiscard]] bool isValid() const {
    constexpr double kSquare = kLargestAxisRatio * kLargestAxisRatio;
    return curve.allFinite() && curve[0] > 0 &&
           oblong() <= (kSquare - 1) / (kSquare + 1) * curve[0];
  }
  /// The radius of a disc of the same area.
  [[nodiscard]] double radius() const {
    return std::pow(curve[0] * curve[0] - oblong() * oblong(), -0.25);
  }
  /// The step to its middle, along the two axes of the plane.
  [[nodiscard]] Eigen::Vector2d middle() const {
    return -0.5 * std::pow(curve[0], -1.5) * Eigen::Vector2d(curve[1], curve[2]);
  }
};

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

/// Sets the angles and distances of places about an axis.
void measureAbout(const Vector3d& centre, const Vector3d& axis, std::vector<WallPlace>& places) {
  const auto [u, v] = planeBasis(axis);
  for (WallPlace& p : places) {
    const Vector3d offset = p.position - centre;
    const double a = offset.dot(u), b = offset.dot(v);
    p.angle = std::atan2(b, a);
    p.distance = std::hypot(a, b);
    p.row = Section::rowAt(p.angle, offset.dot(axis));
  }
}

/// The section through most of the places, by least squares of the distance to its wall with
/// Tukey's weights, from a circle of that radius on.
Section fitWall(const std::vector<WallPlace>& places, double radius) {
  Section section;
  section.curve[0] = 1.0 / (radius * radius);
  for (int round = 0; round < kReweightings && section.isValid(); ++round) {
    std::vector<double> walls, residuals;
    for (const WallPlace& p : places) {
      walls.push_back(section.wallAt(p));
      residuals.push_back(std::abs(p.distance - walls.back()));
    }
    const double scale = std::max(kDeviationOfMedian * median(residuals), 1e-3 * radius);
    Eigen::Matrix<double, kUnknowns, kUnknowns> normal;
    normal.setZero();
    Unknowns right = Unknowns::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double t = residuals[i] / (kBiweightDeviations * scale);
      if (t >= 1) continue;
      // move of the wall for a change of the inverse square
      const double slope = 0.5 * walls[i] * walls[i] * walls[i];
      const double weight = (1 - t * t) * (1 - t * t) * slope * slope;
      const double distance = std::max(places[i].distance, 1e-3 * radius);
      normal += weight * places[i].row * places[i].row.transpose();
      right += weight / (distance * distance) * places[i].row;
    }
    normal.diagonal().array() += 1e-9 * normal.trace();
    const Unknowns next = normal.ldlt().solve(right);
    const bool isDone = (next - section.curve).norm() < kSectionConverged * section.curve.norm();
    section.curve = next;
    if (isDone) break;
  }
  return section;
}

std::size_t sectorsWith(const std::vector<WallPlace>& places) {
  std::bitset<kSectors> seen;
  for (const WallPlace& p : places) {
    const double turn = p.angle / (2 * std::numbers::pi) + 0.5;
    seen.set(std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1));
  }
  return seen.count();
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
  Section section;
  for (int move = 0; move < kMoves; ++move) {
    measureAbout(centre, axis, places);
    section = fitWall(places, node.radius);
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
