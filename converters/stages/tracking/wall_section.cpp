// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_section.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
/// Of a section's wall: see Section.
constexpr int kUnknowns = 7;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

/// Of the strength of the node's wall: what is weaker is none.
constexpr double kLeastStrength = 0.3;
/// Of the way to a wall: where it must be in the lumen.
constexpr double kOnTheWay[] = {0.4, 0.6, 0.8};
/// Rounds of reweighting, and the robust width (in standard deviations) beyond which a point counts
/// for nothing (J. Tukey's biweight).
constexpr int kReweightings = 12;
constexpr double kStands = 1e-3;  // of the unknowns, from round to round
constexpr double kBiweight = 4.685, kDeviations = 1.4826;
/// The longest section, as the ratio of its axes: a longer one is two vessels. Rays of kRayRadii show
/// it in full around a circle that fits between its sides.
constexpr double kMostOblong = 2.5;
/// Times that the section is moved to its own middle, and by how much of the radius at most in all.
constexpr int kMoves = 3;
constexpr double kMostAside = 0.75;
/// Sectors around the axis, and how many must have wall points.
constexpr std::size_t kSectors = 12, kLeastSectors = 8;
/// Times the wall points of the cylinder: what a section must explain to be believed.
constexpr double kMore = 1.25;

/// A wall point about an axis.
struct WallPlace {
  Vector3d position;
  double angle = 0, distance = 0;
  Unknowns row = Unknowns::Zero();  ///< of the section's unknowns; see Section
};

/// An ellipse about that axis, which widens or narrows along it: the inverse square of the distance of
/// its wall is linear in the sine and cosine of twice the angle; those of the angle itself move it, to
/// first order; the place along the axis and its square are a taper and a throat.
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
    constexpr double kSquare = kMostOblong * kMostOblong;
    return curve.allFinite() && curve[0] > 0 &&
           oblong() <= (kSquare - 1) / (kSquare + 1) * curve[0];
  }
  /// Of a disc of the same area.
  [[nodiscard]] double radius() const {
    return std::pow(curve[0] * curve[0] - oblong() * oblong(), -0.25);
  }
  /// To its middle, along the two axes of the plane.
  [[nodiscard]] Eigen::Vector2d middle() const {
    return -0.5 * std::pow(curve[0], -1.5) * Eigen::Vector2d(curve[1], curve[2]);
  }
};

/// Points that rays from a node's centre meet: in its height, at a wall, with lumen on the way.
std::vector<WallPlace> placesAround(const TrackContext& context, const TrackedNode& node,
                                    const Vector3d& axis, TrackWorkspace& workspace) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const double sign = context.options.dark ? -1.0 : 1.0;
  const auto valueAt = [&](const Vector3d& p) {
    return sign * context.volume.sample(geometry.indexFromWorld(p));
  };
  std::vector<double> levels;
  for (const formats::Vec3f& p : node.points) levels.push_back(valueAt(toEigen(p)));
  const double level = median(std::move(levels));
  Candidates& points = workspace.candidates;
  workspace.caster.cast(node.centre, kRayRadii * node.radius, points);
  std::vector<WallPlace> places;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const Vector3d offset = points.offset(i);
    if (std::abs(offset.dot(axis)) > 0.5 * node.height) continue;
    if (points.strength[i] < kLeastStrength * node.strength) continue;
    const bool isLumen = std::all_of(std::begin(kOnTheWay), std::end(kOnTheWay), [&](double share) {
      return valueAt(node.centre + share * offset) > level;
    });
    if (!isLumen) continue;
    places.push_back({node.centre + offset});
  }
  return places;
}

/// Angles and distances about an axis.
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

/// The section through most of the places, by least squares of the distance to its wall with Tukey's
/// weights, from a circle of that radius on.
Section fitWall(const std::vector<WallPlace>& places, double radius) {
  Section section;
  section.curve[0] = 1.0 / (radius * radius);
  for (int round = 0; round < kReweightings && section.isValid(); ++round) {
    std::vector<double> walls, residuals;
    for (const WallPlace& p : places) {
      walls.push_back(section.wallAt(p));
      residuals.push_back(std::abs(p.distance - walls.back()));
    }
    const double scale = std::max(kDeviations * median(residuals), 1e-3 * radius);
    Eigen::Matrix<double, kUnknowns, kUnknowns> normal;
    normal.setZero();
    Unknowns right = Unknowns::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double t = residuals[i] / (kBiweight * scale);
      if (t >= 1) continue;
      // what a change of the inverse square moves the wall by
      const double slope = 0.5 * walls[i] * walls[i] * walls[i];
      const double weight = (1 - t * t) * (1 - t * t) * slope * slope;
      const double distance = std::max(places[i].distance, 1e-3 * radius);
      normal += weight * places[i].row * places[i].row.transpose();
      right += weight / (distance * distance) * places[i].row;
    }
    normal.diagonal().array() += 1e-9 * normal.trace();
    const Unknowns next = normal.ldlt().solve(right);
    const bool isDone = (next - section.curve).norm() < kStands * section.curve.norm();
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

/// From the nearest node before, to the nearest behind, that is a radius away, or the end: what lies
/// nearer tells where a fit leant to rather than where the vessel runs.
Vector3d chordAt(const std::vector<TrackedNode>& nodes, std::size_t n) {
  const auto isFar = [&](std::size_t i) {
    return (nodes[i].centre - nodes[n].centre).norm() >= nodes[n].radius;
  };
  std::size_t before = n, behind = n;
  while (before > 0 && !isFar(before)) --before;
  while (behind + 1 < nodes.size() && !isFar(behind)) ++behind;
  return nodes[behind].centre - nodes[before].centre;
}

/// The sectors that the node's own wall points lie in.
std::size_t sectorsOf(const TrackedNode& node, const Vector3d& axis) {
  std::vector<WallPlace> places;
  for (const formats::Vec3f& p : node.points) places.push_back({toEigen(p)});
  measureAbout(node.centre, axis, places);
  return sectorsWith(places);
}

}  // namespace

std::optional<TrackedNode> fitSection(const TrackContext& context, const TrackedNode& node,
                                      const Vector3d& axis, TrackWorkspace& workspace) {
  std::vector<WallPlace> places = placesAround(context, node, axis, workspace);
  if (places.size() < kFewestCandidates) return std::nullopt;
  const auto [u, v] = planeBasis(axis);
  Vector3d centre = node.centre;
  Section section;
  for (int move = 0; move < kMoves; ++move) {
    measureAbout(centre, axis, places);
    section = fitWall(places, node.radius);
    if (!section.isValid()) return std::nullopt;
    centre += section.middle()[0] * u + section.middle()[1] * v;
    if ((centre - node.centre).norm() > kMostAside * node.radius) return std::nullopt;
  }
  std::erase_if(places, [&](const WallPlace& p) {
    const double wall = section.wallAt(p);
    return std::abs(p.distance - wall) > context.search.band * wall;
  });
  const std::size_t sectors = sectorsWith(places);
  if (sectors < kLeastSectors || sectors < sectorsOf(node, axis) ||
      static_cast<double>(places.size()) < kMore * static_cast<double>(node.points.size()))
    return std::nullopt;
  TrackedNode out = node;
  out.direction = axis;
  out.centre = centre;
  out.radius = section.radius();
  out.points.clear();
  for (const WallPlace& p : places) out.points.push_back(toVec3f(p.position));
  return out;
}

void fitSections(const TrackContext& context, std::vector<TrackedNode>& nodes,
                 TrackWorkspace& workspace) {
  std::vector<TrackedNode> out = nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const TrackedNode& node = nodes[i];
    if (node.origin != formats::NodeOrigin::Measured || node.points.empty() ||
        node.inlierRate >= context.options.inlierRate)
      continue;
    const Vector3d chord = chordAt(nodes, i);
    if (!(chord.norm() > 0)) continue;
    if (auto fitted = fitSection(context, node, chord.normalized(), workspace))
      out[i] = std::move(*fitted);
  }
  nodes = std::move(out);
}

}  // namespace lumen::convert
