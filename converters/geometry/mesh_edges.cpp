// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace lumen::convert {
namespace {

constexpr double kFlat = 1e-6;  // height over length; coordinates of f32 have about 1e-7

}  // namespace

std::vector<EdgeUse> edgeUses(const std::vector<Triangle>& triangles) {
  // a counting sort by the lower point leaves short runs, in the order of the triangles
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

bool isDegenerate(const TriangleMesh& mesh, const Triangle& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    longest =
        std::max(longest, (mesh.position[t[i]] - mesh.position[t[(i + 1) % 3]]).squaredNorm());
  return 2 * vectorArea(mesh, t).norm() <= kFlat * longest;
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

MeshBox boxOf(const TriangleMesh& mesh) {
  MeshBox box;
  bool any = false;
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) {
      const Eigen::Vector3d& p = mesh.position[v];
      box.low = any ? box.low.cwiseMin(p) : p;
      box.high = any ? box.high.cwiseMax(p) : p;
      any = true;
    }
  return box;
}

}  // namespace lumen::convert
