// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/vessel_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kTaper = 0.5;      // loss of width per length: as fast as a line may get thinner
constexpr double kNarrowest = 0.1;  // medians: a line's point that lies at the wall by mistake
constexpr double kTrim = 1.5;       // widths from a tip: where its path keeps to the middle
constexpr int kLooks = 6;           // points that show the width behind a tip
constexpr int kRounds = 4;          // rounds of centring
constexpr int kSmoothings = 3;      // passes of smoothing in each round
constexpr int kRays = 24;           // rays of a section
constexpr double kClip = 1.6;  // medians of the rays: farther is another vessel, through a fork
constexpr double kMostMoveDepths = 0.5;  // depths: the longest move of a point in a round
constexpr double kChord = 1.0;           // depths on either side: the course at a point
constexpr double kEndChord = 1.5;        // depths: the course at an end

/// (1, 2, 1)/4 on all but the ends.
void smooth(std::vector<Vector3d>& line) {
  if (line.size() < 3) return;
  Vector3d before = line.front();
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vector3d here = line[i];
    line[i] = 0.25 * before + 0.5 * here + 0.25 * line[i + 1];
    before = here;
  }
}

/// The centroid of the section of the lumen around `from` across `axis`.
Vector3d sectionCentre(const LumenGeometry& lumen, const Vector3d& from, const Vector3d& axis) {
  const auto [u, v] = planeBasis(axis);
  std::vector<double> rays;
  std::vector<Vector3d> directions;
  for (int k = 0; k < kRays; ++k) {
    const double angle = 2 * std::numbers::pi * k / kRays;
    directions.emplace_back(std::cos(angle) * u + std::sin(angle) * v);
    const auto hit = lumen.tree().firstHit(from, directions.back());
    if (!hit || !hit->leaves) return from;  // not in the lumen
    rays.push_back(hit->distance);
  }
  const double most = kClip * median(rays);
  for (double& ray : rays) ray = std::min(ray, most);
  Vector3d moment = Vector3d::Zero();
  double area = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::size_t next = (k + 1) % rays.size();
    const double size = rays[k] * rays[next];  // all sectors have the same angle
    area += size;
    moment += size / 3 * (rays[k] * directions[k] + rays[next] * directions[next]);
  }
  return area > 0 ? Vector3d(from + moment / area) : from;
}

/// Straight and even between the points that stay.
void bridge(std::vector<Vector3d>& line, std::size_t last) {
  for (std::size_t i = 1; i < last; ++i)
    line[i] = line[0] + double(i) / double(last) * (line[last] - line[0]);
}

}  // namespace

const MeshEnd* endAt(const Vector3d& tip, const ClosedMesh& surface) {
  const MeshEnd* best = nullptr;
  for (const MeshEnd& end : surface.ends) {
    const double away = (tip - end.centre).norm();
    if (away < kTrim * end.radius && (!best || away < (tip - best->centre).norm())) best = &end;
  }
  return best;
}

TriangleMesh LumenGeometry::extractWall(const ClosedMesh& surface) {
  TriangleMesh wall{surface.mesh.position, {}};
  for (std::size_t t = 0; t < surface.end.size(); ++t)
    if (surface.end[t] == ClosedMesh::kWall) wall.triangle.push_back(surface.mesh.triangle[t]);
  return wall;
}

Vector3d lineDirection(std::span<const Vector3d> line, std::size_t i, double reach) {
  std::size_t a = i, b = i;
  while (a > 0 && (line[a] - line[i]).norm() < reach) --a;
  while (b + 1 < line.size() && (line[b] - line[i]).norm() < reach) ++b;
  const Vector3d chord = line[b] - line[a];
  return chord.norm() > 0 ? Vector3d(chord.normalized()) : Vector3d(Vector3d::UnitZ());
}

std::pair<double, std::size_t> distanceTo(std::span<const Vector3d> line, const Vector3d& point) {
  std::pair<double, std::size_t> best(std::numeric_limits<double>::infinity(), 0);
  double least = best.first;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector3d side = line[i + 1] - line[i];
    const double squared = side.squaredNorm();
    const double t =
        squared > 0 ? std::clamp((point - line[i]).dot(side) / squared, 0.0, 1.0) : 0.0;
    const double away = (point - line[i] - t * side).squaredNorm();
    if (!(away < least)) continue;
    const double distance = std::sqrt(away);
    if (!(distance < best.first)) continue;
    least = away;
    best = {distance, t < 0.5 ? i : i + 1};
  }
  return best;
}

std::vector<double> widthsAlong(std::span<const Vector3d> line, const LumenGeometry& lumen) {
  const std::vector<double> at = lengthsAlong(line);
  std::vector<double> widths(line.size());
  tbb::parallel_for(std::size_t{0}, line.size(),
                    [&](std::size_t i) { widths[i] = lumen.depth(line[i]); });
  const double least = std::max(kNarrowest * median(widths), 1e-4 * at.back());
  for (double& width : widths) width = std::max(width, least);
  // from either end: a point is at least as wide as its neighbour less half the distance from it
  for (std::size_t i = 1; i < widths.size(); ++i)
    widths[i] = std::max(widths[i], widths[i - 1] - kTaper * (at[i] - at[i - 1]));
  for (std::size_t i = widths.size() - 1; i > 0; --i)
    widths[i - 1] = std::max(widths[i - 1], widths[i] - kTaper * (at[i] - at[i - 1]));
  return widths;
}

std::vector<double> lengthsAlong(std::span<const Vector3d> line) {
  std::vector<double> at(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) at[i] = at[i - 1] + (line[i] - line[i - 1]).norm();
  return at;
}

Vector3d placeAt(std::span<const Vector3d> line, std::span<const double> lengths, double length) {
  const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, length);
  const auto i = static_cast<std::size_t>(above - lengths.begin());
  const double side = lengths[i] - lengths[i - 1];
  const double share = side > 0 ? std::clamp((length - lengths[i - 1]) / side, 0.0, 1.0) : 0.0;
  return line[i - 1] + share * (line[i] - line[i - 1]);
}

std::vector<Vector3d> evenly(std::span<const Vector3d> line, const LumenGeometry& lumen) {
  const std::vector<double> at = lengthsAlong(line);
  if (line.size() < 2 || !(at.back() > 0)) return {line.begin(), line.end()};
  // how many steps there are to each point
  std::vector<double> steps(line.size(), 0.0);
  const std::vector<double> depth = widthsAlong(line, lumen);
  for (std::size_t i = 1; i < line.size(); ++i)
    steps[i] =
        steps[i - 1] + (at[i] - at[i - 1]) * 0.5 * (1 / depth[i] + 1 / depth[i - 1]) / kLineStep;
  const auto count = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(steps.back())));
  std::vector<Vector3d> out;
  for (std::size_t n = 0; n <= count; ++n)
    out.push_back(placeAt(line, steps, steps.back() * double(n) / double(count)));
  return out;
}

void measureDepths(VesselLine& line, const LumenGeometry& lumen) {
  line.depth.resize(line.point.size());
  tbb::parallel_for(std::size_t{0}, line.point.size(),
                    [&](std::size_t i) { line.depth[i] = lumen.depth(line.point[i]); });
}

void centre(VesselLine& line, const VesselLine* parent, const LumenGeometry& lumen) {
  std::vector<Vector3d>& point = line.point;
  for (int round = 0; round < kRounds; ++round) {
    point = evenly(point, lumen);
    for (int pass = 0; pass < kSmoothings; ++pass) smooth(point);
    std::vector<Vector3d> moved = point;
    std::vector<std::uint8_t> isInParent(point.size(), 0);
    const std::size_t last = point.size() - 1;
    tbb::parallel_for(std::size_t{0}, point.size(), [&](std::size_t i) {
      if (parent) {
        const auto [away, near] = distanceTo(parent->point, point[i]);
        isInParent[i] = away < 1.1 * parent->depth[near] ? 1 : 0;
      }
      const bool isEnd = i == 0 || (i == last && line.meets >= 0);
      if (isInParent[i] || (isEnd && (parent || i == last))) return;
      const double depth = lumen.depth(point[i]);
      const Vector3d axis = lineDirection(point, i, kChord * depth);
      const Vector3d toMiddle = sectionCentre(lumen, point[i], axis) - point[i];
      const double most = kMostMoveDepths * depth;
      moved[i] = point[i] + (toMiddle.norm() > most ? Vector3d(toMiddle * (most / toMiddle.norm()))
                                                    : toMiddle);
    });
    point = std::move(moved);
    std::size_t out = 0;
    while (out < last && isInParent[out]) ++out;
    if (parent) bridge(point, out);
  }
  smooth(point);
}

void trim(VesselLine& line, bool atStart, const LumenGeometry& lumen) {
  std::vector<Vector3d>& point = line.point;
  if (atStart) std::reverse(point.begin(), point.end());
  std::reverse(point.begin(), point.end());  // the tip first
  if (const MeshEnd* end = endAt(point.front(), lumen.surface())) {
    std::size_t near = 0;
    while (near + 2 < point.size() && (point[near] - end->centre).norm() < kTrim * end->radius)
      ++near;
    point.erase(point.begin(), point.begin() + static_cast<std::ptrdiff_t>(near));
    point.insert(point.begin(), end->centre - 0.5 * end->radius * end->normal);
    std::reverse(point.begin(), point.end());
    if (atStart) std::reverse(point.begin(), point.end());
    return;
  }
  const std::vector<double> at = lengthsAlong(point);
  // a tip may lie in a corner: how wide the vessel is shows a little farther in
  double depth = lumen.depth(point.front());
  for (int look = 0; look < kLooks; ++look)
    for (std::size_t i = 1; i < point.size() && (i < 4 || at[i] <= 2 * depth); ++i)
      depth = std::max(depth, lumen.depth(point[i]));
  std::size_t first = 0;
  while (first + 2 < point.size() && at[first] < kTrim * depth) ++first;
  point.erase(point.begin(), point.begin() + static_cast<std::ptrdiff_t>(first));
  std::reverse(point.begin(), point.end());
  if (atStart) std::reverse(point.begin(), point.end());
}

void extend(VesselLine& line, bool atStart, double reach, const LumenGeometry& lumen) {
  std::vector<Vector3d>& point = line.point;
  if (point.size() < 2) return;
  if (atStart) std::reverse(point.begin(), point.end());
  const Vector3d tip = point.back();
  const double depth = lumen.depth(tip);
  std::size_t from = point.size() - 1;
  while (from > 0 && (point[from] - tip).norm() < kEndChord * depth) --from;
  const Vector3d course = (tip - point[from]).normalized();
  const auto hit = lumen.tree().firstHit(tip, course);
  if (hit && hit->leaves && hit->distance <= reach * depth) {
    Vector3d end = tip + hit->distance * course;
    if (!lumen.isWall(hit->triangle)) {
      const MeshEnd& cap = lumen.surface().ends[lumen.surface().end[hit->triangle]];
      if (lumen.tree().isFree(tip, cap.centre + 1e-6 * (tip - cap.centre))) end = cap.centre;
    }
    point.push_back(end);
    (atStart ? line.reachesStart : line.reachesEnd) = true;
  }
  if (atStart) std::reverse(point.begin(), point.end());
}

}  // namespace lumen::convert
