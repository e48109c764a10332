// SPDX-License-Identifier: Apache-2.0
// Declared in follow_courses.h.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/axis_curve.h"
#include "converters/stages/tracking/cylinders/cylinder_equations.h"
#include "converters/stages/tracking/follow_courses.h"
#include "converters/stages/tracking/node_fit.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Largest distance of a fitted node from the line, in interpolated radii.
constexpr double kAsideRadii = 0.7;

using Station = AxisPoint;

/// Places along a polyline, half a radius apart, without its ends.
class Stations {
public:
  explicit Stations(std::span<const Vector3d> line) : m_line(line), m_at(line.size(), 0.0) {
    for (std::size_t i = 1; i < line.size(); ++i)
      m_at[i] = m_at[i - 1] + (line[i] - line[i - 1]).norm();
  }

  /// Evenly spaced, for radii from `first` to `last`.
  [[nodiscard]] std::vector<Station> between(double first, double last) const {
    const double length = m_at.back();
    const int count =
        static_cast<int>(std::floor(length / (kSpacingRadii * std::min(first, last))));
    std::vector<Station> out;
    for (int n = 1; n < count; ++n)
      add(length * n / count, 0.5 * length / count, first + (last - first) * n / count, out);
    return out;
  }

  /// For a radius at each point of the line; at its ends, too, where `isAtEnd` is true of them.
  template <class IsAtEnd>
  [[nodiscard]] std::vector<Station> by(std::span<const double> radii,
                                        const IsAtEnd& isAtEnd) const {
    std::vector<Station> out;
    for (double t = 0; t < m_at.back();) {
      const auto [i, share] = segmentAt(t);
      const double radius = radii[i - 1] + share * (radii[i] - radii[i - 1]);
      if (t > 0 || isAtEnd(m_line.front())) add(t, radius, radius, out);
      t += kSpacingRadii * radius;
    }
    if (isAtEnd(m_line.back())) add(m_at.back(), radii.back(), radii.back(), out);
    return out;
  }

private:
  /// The end of the segment at a length, and the share of that segment before the length.
  [[nodiscard]] std::pair<std::size_t, double> segmentAt(double t) const {
    const auto above = std::upper_bound(m_at.begin() + 1, m_at.end() - 1, t);
    const auto i = static_cast<std::size_t>(above - m_at.begin());
    const double share = m_at[i] > m_at[i - 1] ? (t - m_at[i - 1]) / (m_at[i] - m_at[i - 1]) : 0.0;
    return {i, share};
  }
  [[nodiscard]] Vector3d place(double t) const {
    const auto [i, share] = segmentAt(t);
    return m_line[i - 1] + share * (m_line[i] - m_line[i - 1]);
  }
  /// Adds the place at a length with the direction of the chord over `half` on either side.
  void add(double t, double half, double radius, std::vector<Station>& out) const {
    const Vector3d tangent =
        place(std::min(t + half, m_at.back())) - place(std::max(t - half, 0.0));
    if (tangent.norm() > 0) out.push_back({place(t), tangent.normalized(), radius});
  }

  std::span<const Vector3d> m_line;
  std::vector<double> m_at;  ///< mm from the first point
};

/// True if a place lies in a voxel at a face of the volume, or at the border of its image: its
/// vessel goes on, and has no rounded end there.
bool liesAtFace(const VolumeGeometry& geometry, const Vector3d& place) {
  const Eigen::Array3d index = geometry.indexFromWorld(place).array();
  const Eigen::Array3d last = geometry.cells().high().cast<double>().array();
  return (index < 0.5 || index > last - 0.5).any() ||
         geometry.isBesideNoImage(VolumeGeometry::nearestCell(index));
}

bool inLumen(const TrackedBranch* other, const Vector3d& point) {
  if (!other) return false;
  const ChainPoint at = closestOnChain(other->nodes, point);
  return at.distance < at.radius;
}

TrackedNode bridgedNode(const Station& station) {
  TrackedNode node;
  node.origin = formats::NodeOrigin::Bridged;
  node.centre = station.position;
  node.direction = station.direction;
  node.radius = station.radius;
  node.height = 2 * kSpacingRadii * station.radius;
  return node;
}

/// True if no half of the section through a node is without wall: a vessel's wall lies around its
/// axis, that of a bump on another vessel on one side.
bool isSurrounded(const TrackedNode& node) {
  const Vector3d u = node.direction.unitOrthogonal(), v = node.direction.cross(u);
  std::vector<double> angles;
  for (const formats::Vec3f& point : node.points) {
    const Vector3d out = toEigen(point) - node.centre;
    angles.push_back(std::atan2(out.dot(v), out.dot(u)));
  }
  if (angles.empty()) return false;
  std::sort(angles.begin(), angles.end());
  double last = angles.back() - 2 * std::numbers::pi;
  for (const double angle : angles)
    if (angle - std::exchange(last, angle) >= std::numbers::pi) return false;
  return true;
}

/// The node that fits at a station, of about its radius and course; empty if there is none.
std::optional<TrackedNode> nodeAt(TrackRun& run, const Station& station, double narrow,
                                  double wide) {
  const NodeGuess guess{station.position, station.direction, station.radius, true,
                        0.5 * kSpacingRadii * station.radius};
  std::optional<TrackedNode> node = fitNode(run, guess, leastInlierRate(run.context.options)).node;
  if (!node) return node;
  const Vector3d aside = node->centre - station.position;
  if (aside.norm() > kAsideRadii * station.radius || node->radius < narrow * station.radius ||
      node->radius > wide * station.radius ||
      node->direction.dot(station.direction) < std::numbers::sqrt2 / 2 ||
      (run.context.rules.isSurrounded && !isSurrounded(*node)))
    node.reset();
  return node;
}

/// The nodes that fit at stations; empty where none does.
using Fits = std::vector<std::optional<TrackedNode>>;

/// The median radius of the fitted nodes around one, or 0 if there are too few.
double radiusAround(const Fits& nodes, std::size_t at) {
  constexpr std::size_t kNodesAround = 6, kFewestAround = 4;
  std::vector<double> radii;
  const std::size_t end = std::min(nodes.size(), at + kNodesAround + 1);
  for (std::size_t i = at < kNodesAround ? 0 : at - kNodesAround; i < end; ++i)
    if (nodes[i]) radii.push_back(nodes[i]->radius);
  return radii.size() < kFewestAround ? 0 : upperMedian(radii);
}

void dropTurnedBack(Fits& nodes) {
  std::vector<const TrackedNode*> fitted;
  for (const auto& node : nodes) fitted.push_back(node ? &*node : nullptr);
  const std::vector<bool> isBack = turnedBack(fitted);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (isBack[i]) nodes[i].reset();
}

AxisPoint axisAt(const TrackedNode& node) {
  return {node.centre, node.direction, node.radius};
}

double measureLength(std::span<const Station> course) {
  double length = 0;
  for (std::size_t i = 1; i < course.size(); ++i)
    length += (course[i].position - course[i - 1].position).norm();
  return length;
}

/// The stations of a course between two nodes that fit, moved aside so that it meets both.
std::vector<Station> movedCourse(const TrackedNode& a, const TrackedNode& b,
                                 std::span<const Station> course) {
  const auto aside = [](const TrackedNode& node, const Station& station) -> Vector3d {
    const Vector3d to = node.centre - station.position;
    return to - station.direction.dot(to) * station.direction;
  };
  const Vector3d first = aside(a, course.front()), last = aside(b, course.back());
  std::vector<Station> moved;
  for (std::size_t i = 1; i + 1 < course.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(course.size() - 1);
    moved.push_back(course[i]);
    moved.back().position += (1 - t) * first + t * last;
    moved.back().radius = (1 - t) * a.radius + t * b.radius;
  }
  return moved;
}

/// True if no station of a curve lies farther than its radius from that of the course.
bool isNear(std::span<const Station> curve, std::span<const Station> course) {
  for (std::size_t i = 0; i < curve.size(); ++i)
    if ((curve[i].position - course[i].position).norm() > curve[i].radius) return false;
  return true;
}

/// Moves the stations at which no node fits: a course through voxels has kinks where vessels fork
/// or touch. Between two nodes that fit they lie on the curve that these point along, or, where
/// that leaves the course, on the course, moved so that it meets both. `fit` tries them there.
template <class Fit>
void bridge(std::vector<Station>& stations, Fits& nodes, const Fit& fit) {
  std::size_t last = nodes.size();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i]) continue;
    const std::size_t a = std::exchange(last, i);
    if (a + 1 >= i) continue;
    const auto course = std::span(stations).subspan(a, i - a + 1);
    const std::vector<Station> moved = movedCourse(*nodes[a], *nodes[i], course);
    const std::vector<Station> curve =
        curveBetween(axisAt(*nodes[a]), axisAt(*nodes[i]), moved.size(), measureLength(course));
    const std::vector<Station>& taken = isNear(curve, moved) ? curve : moved;
    for (std::size_t k = 0; k < taken.size(); ++k) {
      stations[a + 1 + k] = taken[k];
      nodes[a + 1 + k] = fit(taken[k]);
    }
  }
}

}  // namespace

std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Vector3d> line, double first,
                                    double last, const TrackedBranch* parent) {
  std::vector<TrackedNode> nodes;
  for (const Station& station : Stations(line).between(first, last)) {
    std::optional<TrackedNode> node;
    if (!inLumen(parent, station.position)) node = nodeAt(run, station, kNarrowest, kWidest);
    nodes.push_back(node ? std::move(*node) : bridgedNode(station));
  }
  return nodes;
}

std::vector<TrackedNode> nodesAlong(TrackRun& run, std::span<const Vector3d> line,
                                    std::span<const double> radii) {
  const VolumeGeometry& geometry = run.context.volume.geometry();
  // a depth among voxels may be less than the radius by half a voxel
  const double unsure = 0.5 * geometry.spacing.maxCoeff();
  std::vector<Station> stations =
      Stations(line).by(radii, [&](const Vector3d& end) { return liesAtFace(geometry, end); });
  Fits found;
  for (const Station& station : stations) {
    run.context.progress.check();
    found.push_back(nodeAt(run, station, kLeastOfDepth, kMostOfDepth));
    if (found.back() || unsure <= (kMostOfDepth - 1) * station.radius) continue;
    Station wider = station;
    wider.radius += unsure;
    found.back() = nodeAt(run, wider, kLeastOfDepth, kMostOfDepth);
  }
  const Fits before = found;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double around = radiusAround(before, i);
    if (around == 0) continue;
    stations[i].radius = around;
    if (!found[i]) found[i] = nodeAt(run, stations[i], kNarrowest, kWidest);
  }
  dropTurnedBack(found);
  bridge(stations, found,
         [&](const Station& station) { return nodeAt(run, station, kNarrowest, kWidest); });
  dropTurnedBack(found);
  bridge(stations, found, [](const Station&) { return std::nullopt; });
  std::vector<TrackedNode> nodes;
  for (std::size_t i = 0; i < stations.size(); ++i)
    nodes.push_back(found[i] ? std::move(*found[i]) : bridgedNode(stations[i]));
  return nodes;
}

std::optional<TrackedNode> nodeBetween(TrackRun& run, const TrackedNode& before,
                                       const TrackedNode& bridged, const TrackedNode& after) {
  std::optional<TrackedNode> node = nodeAt(run, axisAt(bridged), kNarrowest, kWidest);
  if (node && !(isAhead(before, *node) && isAhead(*node, after))) node.reset();
  return node;
}

}  // namespace lumen::convert
