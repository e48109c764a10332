// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/anatomy/vessel_network.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "converters/base/statistics.h"

namespace lumen::convert {
namespace {

constexpr double kThinnest = 0.3;  // mm: the radii of thinner vessels are not known

}  // namespace

VesselNetwork::VesselNetwork(const formats::CenterlineTree& tree)
    : m_tree(tree), m_neighbours(tree.nodeCount()) {
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    m_neighbours[a].push_back(b);
    m_neighbours[b].push_back(a);
  };
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] != formats::kNoParent) join(n, static_cast<std::uint32_t>(tree.parent[n]));
  for (const auto& link : tree.links) join(link[0], link[1]);
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (m_neighbours[n].size() == 1) m_ends.push_back(n);
}

double VesselNetwork::length(std::uint32_t a, std::uint32_t b) const {
  return (position(a) - position(b)).norm();
}

double VesselNetwork::lengthOf(std::span<const std::uint32_t> way) const {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += length(way[i - 1], way[i]);
  return sum;
}

double VesselNetwork::medianRadius(std::span<const std::uint32_t> nodes) const {
  std::vector<double> radii;
  for (const std::uint32_t n : nodes) radii.push_back(double{m_tree.radius[n]});
  return radii.empty() ? 0 : median(radii);
}

NodeSet VesselNetwork::setOf(std::span<const std::uint32_t> nodes) const {
  NodeSet set(m_neighbours.size(), false);
  for (const std::uint32_t n : nodes) set[n] = true;
  return set;
}

VesselNetwork::Ways VesselNetwork::waysFrom(std::uint32_t node, const NodeSet& closed, WayCost cost,
                                            double most) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Ways ways{std::vector<double>(m_neighbours.size(), kFar),
            std::vector<std::uint32_t>(m_neighbours.size(), kNone)};
  using Open = std::pair<double, std::uint32_t>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  ways.cost[node] = 0;
  open.emplace(0, node);
  while (!open.empty()) {
    const auto [here, n] = open.top();
    open.pop();
    if (here > ways.cost[n]) continue;
    for (const std::uint32_t next : m_neighbours[n]) {
      if (!closed.empty() && closed[next]) continue;
      double step = length(n, next);
      if (cost == WayCost::Resistance) {
        const double width =
            std::max(kThinnest, 0.5 * (double{m_tree.radius[n]} + double{m_tree.radius[next]}));
        step /= width * width * width * width;
      }
      if (here + step > most || !(here + step < ways.cost[next])) continue;
      ways.cost[next] = here + step;
      ways.before[next] = n;
      open.emplace(here + step, next);
    }
  }
  return ways;
}

std::vector<std::uint32_t> VesselNetwork::Ways::reached() const {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t n = 0; n < cost.size(); ++n)
    if (reach(n)) nodes.push_back(n);
  return nodes;
}

std::vector<std::uint32_t> VesselNetwork::Ways::to(std::uint32_t node) const {
  std::vector<std::uint32_t> nodes;
  for (; node != kNone; node = before[node]) nodes.push_back(node);
  std::reverse(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace lumen::convert
