// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/mujoco/wire_reach.h"

#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/vectors.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/geometry/triangle_mesh.h"
#include "converters/geometry/triangle_tree.h"

namespace lumen::convert {

namespace {

using formats::CenterlineTree;

std::vector<std::vector<std::uint32_t>> findNeighbours(const CenterlineTree& tree) {
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

/// mm from `node` to each node; infinity where there is no path.
std::vector<double> distancesFrom(const CenterlineTree& tree, std::uint32_t node) {
  const auto neighbours = findNeighbours(tree);
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

/// A piece as MuJoCo sees it: a box, in which the nearest triangle decides the side.
class PieceSolid {
public:
  explicit PieceSolid(const SurfaceMesh& piece) : m_mesh(makeMesh(piece)), m_tree(m_mesh) {
    const Box3d box = boundingBox(m_mesh);
    m_low = box.low;
    m_high = box.high;
  }
  PieceSolid(const PieceSolid&) = delete;
  PieceSolid& operator=(const PieceSolid&) = delete;

  [[nodiscard]] bool isTouched(const Eigen::Vector3d& p, double radius) const {
    if (((p - m_low).array() < -radius).any() || ((p - m_high).array() > radius).any())
      return false;
    const NearestPoint near = m_tree.nearest(p);
    return near.distance < radius || m_tree.normal(near.triangle).dot(p - near.position) < 0;
  }

private:
  static TriangleMesh makeMesh(const SurfaceMesh& piece) {
    TriangleMesh mesh;
    for (const Float3& p : piece.position) mesh.position.push_back(toEigen(p));
    mesh.triangle = piece.triangle;
    return mesh;
  }

  TriangleMesh m_mesh;
  TriangleTree m_tree;
  Eigen::Vector3d m_low, m_high;
};

}  // namespace

double freeBehind(const std::vector<SurfaceMesh>& pieces, const Eigen::Vector3d& tip,
                  const Eigen::Vector3d& direction, double length, double radius) {
  double free = length;
  for (const SurfaceMesh& piece : pieces) {
    if (piece.triangle.empty()) continue;
    const PieceSolid solid(piece);
    for (double behind = 0; behind < free; behind += radius)
      if (solid.isTouched(tip - behind * direction, radius)) free = behind;
  }
  return free;
}

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
