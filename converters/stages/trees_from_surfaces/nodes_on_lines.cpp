// SPDX-License-Identifier: Apache-2.0
// Declared in vessel_line.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/geometry/icosphere.h"
#include "converters/stages/trees_from_surfaces/vessel_line.h"
#include "formats/case/node_origin.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::NodeOrigin;

constexpr double kSpacing = 1.0;  // widths from one node to the next
constexpr int kRayOrder = 3;      // an icosphere of 162 rays, as tracking has
constexpr int kNearEdges = 12;    // edges along the tree within which nodes share out the wall
// Share of the squared distance of two nodes by which a node's power may exceed the other's.
// Halfway between them it is 0, at the other's own section 1.
constexpr double kShared = 0.5;
constexpr double kBand = 0.1;            // radii, as tracking's inliers
constexpr double kWidest = 1.5;          // depths: the radius of a section that is not round
constexpr std::size_t kLeastPoints = 8;  // for a radius

/// A node before it is one of a case.
struct Station {
  Vector3d centre, direction;
  double radius = 0, height = 0;
  bool isBridged = false;
};

/// The places of a line's nodes, in spacings from its first point, and their number.
struct Spread {
  double first = 0, step = 0;
  std::size_t count = 0;
};

/// `total`: spacings along the line.
Spread chooseSpread(const VesselLine& line, double total) {
  const double before = line.parent >= 0 ? 1 : line.reachesStart ? 0.5 : 0;
  const double after = line.reachesEnd ? 0.5 : 0;
  const double room = std::max(0.0, std::round(total - before - after));
  const double parts = before + after + room;
  Spread spread;
  spread.count = static_cast<std::size_t>(room) + 1;
  spread.step = parts > 0 ? total / parts : 0;
  spread.first = parts > 0 ? before * spread.step : 0.5 * total;
  return spread;
}

/// Bridges the part of a child within its parent's lumen, which was not measured; it is as wide as
/// at its exit.
void bridgeWithin(const VesselLine& parent, std::vector<Station>& out) {
  std::size_t free = 0;
  for (; free < out.size(); ++free) {
    const auto [away, near] = distanceTo(parent.point, out[free].centre);
    if (away >= parent.depth[near]) break;
  }
  if (free == out.size()) free = out.size() - 1;  // the tip of a stub stays its own
  for (std::size_t i = 0; i < free; ++i) {
    out[i].isBridged = true;
    out[i].radius = std::min(out[i].radius, out[free].radius);
  }
}

std::vector<Station> stationsOn(const VesselLine& line, const VesselLine* parent,
                                const LumenGeometry& lumen) {
  const std::vector<Vector3d> even = evenly(line.point, lumen);
  const std::vector<double> widths = widthsAlong(even, lumen);
  const double perSpacing = kSpacing / kLineStep;  // points of `even`
  const Spread spread = chooseSpread(line, double(even.size() - 1) / perSpacing);
  std::vector<Station> out;
  for (std::size_t k = 0; k < spread.count; ++k) {
    const double at = std::clamp((spread.first + double(k) * spread.step) * perSpacing, 0.0,
                                 double(even.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(at), even.size() - 2);
    const double share = at - double(i);
    Station station;
    station.centre = even[i] + share * (even[i + 1] - even[i]);
    station.radius = widths[i] + share * (widths[i + 1] - widths[i]);
    const auto nearer = share < 0.5 ? i : i + 1;
    station.direction = lineDirection(even, nearer, station.radius);
    station.height = 2 * spread.step * kSpacing * station.radius;
    out.push_back(station);
  }
  // the flat ends of the first and last cylinder are those of the lumen
  if (line.reachesStart) out.front().height = 2 * (out.front().centre - even.front()).norm();
  if (line.reachesEnd) out.back().height = 2 * (out.back().centre - even.back()).norm();
  if (parent) bridgeWithin(*parent, out);
  return out;
}

std::uint32_t nearestNode(const formats::Case& value, std::uint32_t branch, const Vector3d& point) {
  const formats::Branch& record = value.tree.branches[branch];
  std::uint32_t best = record.firstNode;
  for (std::uint32_t n = record.firstNode; n < record.firstNode + record.nodeCount; ++n)
    if ((toEigen(value.tree.centre[n]) - point).squaredNorm() <
        (toEigen(value.tree.centre[best]) - point).squaredNorm())
      best = n;
  return best;
}

/// Appends a branch to the tree.
void append(const VesselLine& line, const std::vector<Station>& stations, formats::Case& out,
            std::vector<NodeOrigin>& origins) {
  formats::CenterlineTree& tree = out.tree;
  const auto first = static_cast<std::int32_t>(tree.nodeCount());
  formats::Branch record;
  record.label = line.label;
  record.kind = line.isSac ? formats::BranchKind::Aneurysm : formats::BranchKind::Vessel;
  record.firstNode = static_cast<std::uint32_t>(first);
  record.nodeCount = static_cast<std::uint32_t>(stations.size());
  if (line.parent >= 0)
    record.parentNode = static_cast<std::int32_t>(
        nearestNode(out, static_cast<std::uint32_t>(line.parent), line.point.front()));
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Station& station = stations[i];
    tree.centre.push_back(toVec3f(station.centre));
    tree.direction.push_back(toVec3f(station.direction));
    tree.radius.push_back(static_cast<float>(station.radius));
    tree.height.push_back(static_cast<float>(station.height));
    tree.inlierRate.push_back(0);
    tree.parent.push_back(i == 0 ? record.parentNode : first + static_cast<std::int32_t>(i) - 1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    origins.push_back(station.isBridged ? NodeOrigin::Bridged : NodeOrigin::Measured);
  }
  tree.branches.push_back(std::move(record));
}

/// The links of lines that close a loop.
void addLinks(const std::vector<VesselLine>& lines, formats::CenterlineTree& tree,
              const formats::Case& value) {
  for (std::uint32_t b = 0; b < lines.size(); ++b) {
    if (lines[b].meets < 0) continue;
    const formats::Branch& record = tree.branches[b];
    const std::uint32_t tip = record.firstNode + record.nodeCount - 1;
    const std::uint32_t other =
        nearestNode(value, static_cast<std::uint32_t>(lines[b].meets), toEigen(tree.centre[tip]));
    if (other == tip || tree.parent[tip] == static_cast<std::int32_t>(other)) continue;
    tree.links.push_back({std::min(tip, other), std::max(tip, other)});
  }
  std::sort(tree.links.begin(), tree.links.end());
  tree.links.erase(std::unique(tree.links.begin(), tree.links.end()), tree.links.end());
}

/// Casts the rays of one node.
class NodeRays {
public:
  NodeRays(const formats::Case& value, const std::vector<NodeOrigin>& origins,
           const LumenGeometry& lumen)
      : m_tree(value.tree),
        m_origins(origins),
        m_lumen(lumen),
        m_neighbours(value.tree),
        m_rays(icosphere(kRayOrder)) {}

  [[nodiscard]] std::vector<formats::Vec3f> points(std::uint32_t node) const {
    const std::vector<std::uint32_t> near = m_neighbours.within(node, kNearEdges);
    std::vector<formats::Vec3f> out;
    if (m_origins[node] != NodeOrigin::Measured) return out;
    for (const Vector3d& ray : m_rays) {
      const auto hit = m_lumen.tree().firstHit(centre(node), ray);
      if (!hit || !hit->leaves || !m_lumen.isWall(hit->triangle)) continue;
      const Vector3d point = centre(node) + hit->distance * ray;
      if (isOwn(node, near, point)) out.push_back(toVec3f(point));
    }
    return out;
  }

  /// The radius of the disc that a node's points surround, and the share of them within the band.
  [[nodiscard]] std::pair<double, double> radius(std::uint32_t node,
                                                 const std::vector<formats::Vec3f>& points) const {
    const Vector3d axis = toEigen(m_tree.direction[node]);
    std::vector<double> away;
    for (const formats::Vec3f& p : points) {
      const Vector3d from = toEigen(p) - centre(node);
      if (std::abs(from.dot(axis)) <= 0.25 * double{m_tree.height[node]})
        away.push_back((from - from.dot(axis) * axis).norm());
    }
    const double depth = m_lumen.depth(centre(node));
    if (away.size() < kLeastPoints) return {double{m_tree.radius[node]}, away.empty() ? 0.0 : 1.0};
    const double radius = std::clamp(median(away), depth, kWidest * depth);
    const auto isIn = [&](double d) { return std::abs(d - radius) <= kBand * radius; };
    return {radius, static_cast<double>(std::count_if(away.begin(), away.end(), isIn)) /
                        static_cast<double>(away.size())};
  }

private:
  [[nodiscard]] Vector3d centre(std::uint32_t node) const { return toEigen(m_tree.centre[node]); }

  [[nodiscard]] bool isOwn(std::uint32_t node, const std::vector<std::uint32_t>& near,
                           const Vector3d& point) const {
    const auto power = [&](std::uint32_t n) {
      return (point - centre(n)).squaredNorm() -
             double{m_tree.radius[n]} * double{m_tree.radius[n]};
    };
    const double own = power(node);
    return std::none_of(near.begin(), near.end(), [&](std::uint32_t other) {
      return other != node && m_origins[other] == NodeOrigin::Measured &&
             own - power(other) > kShared * (centre(node) - centre(other)).squaredNorm();
    });
  }

  const formats::CenterlineTree& m_tree;
  const std::vector<NodeOrigin>& m_origins;
  const LumenGeometry& m_lumen;
  formats::Neighbours m_neighbours;
  std::vector<Vector3d> m_rays;
};

void addPoints(formats::Case& out, const std::vector<NodeOrigin>& origins,
               const LumenGeometry& lumen, double least, Progress& progress) {
  const auto count = static_cast<std::uint32_t>(out.tree.nodeCount());
  progress.begin("wall points", count);
  std::vector<std::vector<formats::Vec3f>> of(count);
  std::vector<std::pair<double, double>> radii(count);
  const NodeRays rays(out, origins, lumen);
  tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t node) {
    progress.check();
    of[node] = rays.points(node);
    radii[node] = rays.radius(node, of[node]);
    progress.advance();
  });
  progress.end();
  out.points.emplace();
  out.points->offset.push_back(0);
  for (std::uint32_t node = 0; node < count; ++node) {
    auto& position = out.points->position;
    position.insert(position.end(), of[node].begin(), of[node].end());
    out.points->offset.push_back(static_cast<std::uint32_t>(position.size()));
    if (origins[node] != NodeOrigin::Measured) continue;
    out.tree.radius[node] = static_cast<float>(std::max(least, radii[node].first));
    out.tree.inlierRate[node] = static_cast<float>(radii[node].second);
  }
}

}  // namespace

formats::Case nodesOnLines(const std::vector<VesselLine>& lines, const LumenGeometry& lumen,
                           double least, Progress& progress) {
  formats::Case out;
  std::vector<NodeOrigin> origins;
  std::vector<std::vector<Station>> stations(lines.size());
  tbb::parallel_for(std::size_t{0}, lines.size(), [&](std::size_t i) {
    progress.check();
    const int parent = lines[i].parent;
    stations[i] = stationsOn(
        lines[i], parent >= 0 ? &lines[static_cast<std::size_t>(parent)] : nullptr, lumen);
  });
  for (std::size_t i = 0; i < lines.size(); ++i) append(lines[i], stations[i], out, origins);
  addLinks(lines, out.tree, out);
  for (float& radius : out.tree.radius) radius = std::max(radius, static_cast<float>(least));
  addPoints(out, origins, lumen, least, progress);
  for (formats::Branch& branch : out.tree.branches) {
    const auto first = out.tree.inlierRate.begin() + branch.firstNode;
    double sum = 0;
    for (auto rate = first; rate != first + branch.nodeCount; ++rate) sum += double{*rate};
    branch.meanInlierRate = static_cast<float>(sum / branch.nodeCount);
  }
  setNodeOrigins(out, origins);
  return out;
}

}  // namespace lumen::convert
