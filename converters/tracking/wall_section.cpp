// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/wall_section.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "converters/common/statistics.h"
#include "converters/common/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Vector5d = Eigen::Matrix<double, 5, 1>;

/// Of the strength of the node's wall: what is weaker is none.
constexpr double kLeastStrength = 0.3;
/// Of the way to a wall: where it must be in the lumen.
constexpr double kOnTheWay[] = {0.4, 0.6, 0.8};
/// Rounds of reweighting, and the robust width (in standard deviations) beyond which a point counts
/// for nothing (J. Tukey's biweight).
constexpr int kRounds = 12;
constexpr double kBiweight = 4.685, kDeviations = 1.4826;
/// The longest ellipse, as the ratio of its axes: a longer one is two vessels. Rays of kRayRadii show
/// it in full around a circle that fits between its sides.
constexpr double kMostOblong = 2.5;
/// Times that the ellipse is moved to its own middle, and by how much of the radius at most in all.
constexpr int kMoves = 3;
constexpr double kMostAside = 0.75;
/// Sectors around the axis, and how many must have wall points.
constexpr std::size_t kSectors = 12, kLeastSectors = 8;
/// Times the wall points of the cylinder: what an ellipse must explain to be believed.
constexpr double kMore = 1.25;

/// A wall point in the plane normal to the axis.
struct WallPlace {
  Vector3d position;
  double angle, distance;
};

/// An ellipse in that plane: the inverse square of the distance of its wall is linear in the sine and
/// cosine of twice the angle; those of the angle itself move it, to first order.
struct Ellipse {
  Vector5d curve = Vector5d::Zero();

  static Vector5d rowAt(double angle) {
    return {1.0, std::cos(angle), std::sin(angle), std::cos(2 * angle), std::sin(2 * angle)};
  }
  [[nodiscard]] double wallAt(double angle) const {
    const double inverse = rowAt(angle).dot(curve);
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
    places.push_back({node.centre + offset, 0, 0});
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
  }
}

/// The ellipse through most of the places, by least squares of the distance to its wall with Tukey's
/// weights, from a circle of that radius on.
Ellipse fitEllipse(const std::vector<WallPlace>& places, double radius) {
  Ellipse ellipse;
  ellipse.curve[0] = 1.0 / (radius * radius);
  for (int round = 0; round < kRounds && ellipse.isValid(); ++round) {
    std::vector<double> residuals;
    for (const WallPlace& p : places)
      residuals.push_back(std::abs(p.distance - ellipse.wallAt(p.angle)));
    const double scale = std::max(kDeviations * median(residuals), 1e-3 * radius);
    Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
    Vector5d right = Vector5d::Zero();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double t = residuals[i] / (kBiweight * scale);
      if (t >= 1) continue;
      // what a change of the inverse square moves the wall by
      const double slope = 0.5 * std::pow(ellipse.wallAt(places[i].angle), 3);
      const double weight = (1 - t * t) * (1 - t * t) * slope * slope;
      const Vector5d row = Ellipse::rowAt(places[i].angle);
      const double distance = std::max(places[i].distance, 1e-3 * radius);
      normal += weight * row * row.transpose();
      right += weight / (distance * distance) * row;
    }
    normal.diagonal().array() += 1e-9 * normal.trace();
    ellipse.curve = normal.ldlt().solve(right);
  }
  return ellipse;
}

std::size_t sectorsWith(const std::vector<WallPlace>& places) {
  std::bitset<kSectors> seen;
  for (const WallPlace& p : places) {
    const double turn = p.angle / (2 * std::numbers::pi) + 0.5;
    seen.set(std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1));
  }
  return seen.count();
}

/// The sectors that the node's own wall points lie in.
std::size_t sectorsOf(const TrackedNode& node, const Vector3d& axis) {
  std::vector<WallPlace> places;
  for (const formats::Vec3f& p : node.points) places.push_back({toEigen(p), 0, 0});
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
  Ellipse ellipse;
  for (int move = 0; move < kMoves; ++move) {
    measureAbout(centre, axis, places);
    ellipse = fitEllipse(places, node.radius);
    if (!ellipse.isValid()) return std::nullopt;
    centre += ellipse.middle()[0] * u + ellipse.middle()[1] * v;
    if ((centre - node.centre).norm() > kMostAside * node.radius) return std::nullopt;
  }
  std::erase_if(places, [&](const WallPlace& p) {
    const double wall = ellipse.wallAt(p.angle);
    return std::abs(p.distance - wall) > context.search.band * wall;
  });
  const std::size_t sectors = sectorsWith(places);
  if (sectors < kLeastSectors || sectors <= sectorsOf(node, axis) ||
      static_cast<double>(places.size()) < kMore * static_cast<double>(node.points.size()))
    return std::nullopt;
  TrackedNode out = node;
  out.direction = axis;
  out.centre = centre;
  out.radius = ellipse.radius();
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
    const Vector3d chord =
        nodes[std::min(i + 1, nodes.size() - 1)].centre - nodes[i > 0 ? i - 1 : 0].centre;
    if (!(chord.norm() > 0)) continue;
    if (auto fitted = fitSection(context, node, chord.normalized(), workspace))
      out[i] = std::move(*fitted);
  }
  nodes = std::move(out);
}

}  // namespace lumen::convert
