// SPDX-License-Identifier: Apache-2.0
#include "converters/export/mujoco/wire_reach.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

std::vector<std::vector<std::uint32_t>> neighboursOf(const CenterlineTree& tree) {
  std::vector<std::vector<std::uint32_t>> neighbours(tree.nodeCount());
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  };
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    if (tree.parent[n] >= 0) join(n, static_cast<std::uint32_t>(tree.parent[n]));
  for (const auto& [a, b] : tree.links) join(a, b);
  return neighbours;
}

/// mm from `node` to each node; infinity where there is no way.
std::vector<double> distancesFrom(const CenterlineTree& tree, std::uint32_t node) {
  const auto neighbours = neighboursOf(tree);
  std::vector<double> distance(tree.nodeCount(), std::numeric_limits<double>::infinity());
  const auto position = [&](std::uint32_t n) {
    const formats::Vec3f& c = tree.centre[n];
    return Eigen::Vector3d(c.x, c.y, c.z);
  };
  using Place = std::pair<double, std::uint32_t>;
  std::priority_queue<Place, std::vector<Place>, std::greater<>> next;
  next.emplace(distance[node] = 0, node);
  while (!next.empty()) {
    const auto [here, at] = next.top();
    next.pop();
    if (here > distance[at]) continue;
    for (const std::uint32_t to : neighbours[at]) {
      const double there = here + (position(to) - position(at)).norm();
      if (there < distance[to]) next.emplace(distance[to] = there, to);
    }
  }
  return distance;
}

}  // namespace

SurfaceMesh wallsInReach(SurfaceMesh mesh, const CenterlineTree& tree, std::uint32_t node,
                         double length) {
  if (mesh.node.size() != mesh.position.size()) return mesh;
  const std::vector<double> distance = distancesFrom(tree, node);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    bool isNear = false;
    for (const std::uint32_t v : mesh.triangle[t])
      isNear = isNear || (mesh.node[v] < distance.size() && distance[mesh.node[v]] <= length);
    if (!isNear) continue;
    mesh.triangle[kept] = mesh.triangle[t];
    mesh.group[kept++] = mesh.group[t];
  }
  mesh.triangle.resize(kept);
  mesh.group.resize(kept);
  return mesh;
}

}  // namespace lumen::convert
