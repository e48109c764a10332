// SPDX-License-Identifier: Apache-2.0
#include "exact_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

#include <tbb/parallel_for.h>

#include "vessel.h"

namespace lumen::bench {
namespace {

struct Edge {
  std::uint32_t to;
  double length;
};
using Edges = std::vector<std::vector<Edge>>;

Edges findEdges(const formats::CenterlineTree& tree) {
  Edges edges(tree.nodeCount());
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    const double length =
        std::hypot(tree.centre[a].x - tree.centre[b].x, tree.centre[a].y - tree.centre[b].y,
                   tree.centre[a].z - tree.centre[b].z);
    edges[a].push_back({b, length});
    edges[b].push_back({a, length});
  };
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i)
    if (tree.parent[i] >= 0) join(i, static_cast<std::uint32_t>(tree.parent[i]));
  for (const auto& link : tree.links) join(link[0], link[1]);
  return edges;
}

// Dijkstra's algorithm. Nodes behind one that is too far are visited too, as they may be wider.
std::vector<std::uint32_t> vesselAround(const Edges& edges, const std::vector<double>& radius,
                                        double greatest, std::uint32_t station) {
  constexpr double kReachRadii = 4;
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> next;
  std::unordered_map<std::uint32_t, double> lengthTo{{station, 0.0}};
  std::vector<std::uint32_t> result;
  next.push({0.0, station});
  while (!next.empty()) {
    const auto [length, node] = next.top();
    next.pop();
    if (length > lengthTo[node]) continue;
    if (length <= kReachRadii * (radius[station] + radius[node])) result.push_back(node);
    for (const Edge& edge : edges[node]) {
      const double there = length + edge.length;
      if (there > kReachRadii * (radius[station] + greatest)) continue;
      const auto [known, isNew] = lengthTo.try_emplace(edge.to, there);
      if (!isNew && known->second <= there) continue;
      known->second = there;
      next.push({there, edge.to});
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

ExactField::ExactField(const formats::Case& source)
    : m_model(scalarModel(source)),
      m_level(blob_model_describe(m_model.get()).iso_level),
      m_vessel(source.tree.nodeCount()) {
  for (const formats::Vec3f& c : source.tree.centre)
    m_centre.insert(m_centre.end(), {c.x, c.y, c.z});
  m_radius.assign(source.tree.radius.begin(), source.tree.radius.end());
  const Edges edges = findEdges(source.tree);
  const double greatest = *std::max_element(m_radius.begin(), m_radius.end());
  tbb::parallel_for(std::size_t{0}, m_vessel.size(), [&](std::size_t i) {
    m_vessel[i] = vesselAround(edges, m_radius, greatest, static_cast<std::uint32_t>(i));
  });
}

double ExactField::power(std::uint32_t node, const double* point) const {
  const double* c = &m_centre[3 * std::size_t{node}];
  const double x = point[0] - c[0], y = point[1] - c[1], z = point[2] - c[2];
  return x * x + y * y + z * z - m_radius[node] * m_radius[node];
}

double ExactField::distanceAt(std::uint32_t node, const double* point) const {
  std::uint32_t cursor = node;
  blob_hessian field;
  blob_query_hessian(m_model.get(), BLOB_BLENDED, point, &cursor, &field);
  cursor = node;
  blob_nearest_point nearest;
  blob_nearest(m_model.get(), BLOB_BLENDED, point, &cursor, 0, 0, &nearest);
  return field.value > m_level ? -std::abs(nearest.distance) : std::abs(nearest.distance);
}

double ExactField::distance(std::uint32_t station, const double* point) const {
  return distanceAt(station, point);
}

double ExactField::ownDistance(std::uint32_t station, const double* point) const {
  std::uint32_t best = station;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t node : m_vessel[station])
    if (const double p = power(node, point); p < least) {
      least = p;
      best = node;
    }
  return distanceAt(best, point);
}

ExactField::Other ExactField::otherVessel(std::uint32_t station, const double* point) const {
  Other result{std::numeric_limits<double>::infinity(), BLOB_NOWHERE};
  double least = std::numeric_limits<double>::infinity();
  const std::vector<std::uint32_t>& own = m_vessel[station];
  auto skip = own.begin();
  for (std::uint32_t node = 0; node < m_radius.size(); ++node) {
    if (skip != own.end() && *skip == node) {
      ++skip;
      continue;
    }
    if (const double p = power(node, point); p < least) {
      least = p;
      result.node = node;
    }
  }
  if (result.node != BLOB_NOWHERE) result.distance = distanceAt(result.node, point);
  return result;
}

}  // namespace lumen::bench
