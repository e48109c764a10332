// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace lumen::convert {

std::vector<EdgeUse> edgeUses(const std::vector<Triangle>& triangles) {
  // a counting sort by the lower point yields short runs, in the order of the triangles
  std::uint32_t points = 0;
  for (const Triangle& t : triangles) points = std::max({points, t[0] + 1, t[1] + 1, t[2] + 1});
  std::vector<std::uint32_t> first(std::size_t{points} + 1, 0);
  const auto sides = static_cast<std::uint32_t>(3 * triangles.size());
  for (std::uint32_t s = 0; s < sides; ++s)
    ++first[std::min(startOf(triangles, s), endOf(triangles, s)) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<EdgeUse> uses(sides);
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t s = 0; s < sides; ++s) {
    const auto [low, high] = std::minmax({startOf(triangles, s), endOf(triangles, s)});
    uses[next[low]++] = {low, high, s};
  }
  for (std::uint32_t p = 0; p < points; ++p)
    std::sort(uses.begin() + first[p], uses.begin() + first[p + 1],
              [](const EdgeUse& a, const EdgeUse& b) {
                return std::tie(a.high, a.side) < std::tie(b.high, b.side);
              });
  return uses;
}

std::vector<std::uint32_t> oppositeSides(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> opposite(3 * triangles.size(), kNoSide);
  forEachEdge(edgeUses(triangles), [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) return;
    opposite[edge[0].side] = edge[1].side;
    opposite[edge[1].side] = edge[0].side;
  });
  return opposite;
}

std::int64_t eulerCharacteristic(const TriangleMesh& mesh) {
  std::vector<bool> isUsed(mesh.position.size(), false);
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) isUsed[v] = true;
  std::int64_t edges = 0;
  forEachEdge(edgeUses(mesh.triangle), [&](std::span<const EdgeUse>) { ++edges; });
  return std::count(isUsed.begin(), isUsed.end(), true) - edges +
         static_cast<std::int64_t>(mesh.triangle.size());
}

std::vector<std::uint32_t> equalPoints(const std::vector<Eigen::Vector3d>& position) {
  std::vector<std::uint32_t> order(position.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    const Eigen::Vector3d& p = position[i];
    return std::tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> same(position.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    same[order[i]] =
        i > 0 && position[order[i]] == position[order[i - 1]] ? same[order[i - 1]] : order[i];
  return same;
}

}  // namespace lumen::convert
