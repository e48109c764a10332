// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/remesh/remesh_target.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <span>
#include <string>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"
#include "formats/case/topology.h"

namespace lumen::convert {

namespace {

constexpr double kGrowth = 0.25;  // per distance: neighbouring edges differ by a quarter at most
constexpr double kEdgesAround = 8;

Eigen::Vector3d centreOf(const formats::CenterlineTree& tree, std::uint32_t node) {
  return {tree.centre[node].x, tree.centre[node].y, tree.centre[node].z};
}

// The radius between `node` and its neighbours in its branch, at the nearest point of the axis: it
// has no steps where the cursor moves to the next node.
double radiusAt(const formats::CenterlineTree& tree, const formats::Neighbours& edges,
                const Eigen::Vector3d& point, std::uint32_t node) {
  const Eigen::Vector3d from = centreOf(tree, node);
  double best = (point - from).squaredNorm(), radius = tree.radius[node];
  for (const std::uint32_t other : edges.of(node)) {
    if (tree.branch[other] != tree.branch[node]) continue;
    const Eigen::Vector3d chord = centreOf(tree, other) - from;
    const double length2 = chord.squaredNorm();
    if (!(length2 > 0)) continue;
    const double share = std::clamp((point - from).dot(chord) / length2, 0.0, 1.0);
    const double distance = (point - from - share * chord).squaredNorm();
    if (distance >= best) continue;
    best = distance;
    radius = (1 - share) * tree.radius[node] + share * tree.radius[other];
  }
  return radius;
}

}  // namespace

// Shortest first, as Dijkstra's algorithm goes.
void gradeLengths(const TriangleMesh& mesh, std::vector<double>& length) {
  std::vector<std::uint32_t> offset(mesh.position.size() + 1, 0), around;
  for (const Triangle& t : mesh.triangle)
    for (const std::uint32_t v : t) ++offset[v + 1];
  for (std::size_t v = 1; v < offset.size(); ++v) offset[v] += offset[v - 1];
  around.resize(mesh.triangle.size() * 3);
  std::vector<std::uint32_t> next(offset.begin(), offset.end() - 1);
  for (const Triangle& t : mesh.triangle)
    for (std::size_t i = 0; i < 3; ++i) around[next[t[i]]++] = t[(i + 1) % 3];
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto lower = [&](std::uint32_t v) {
    for (std::uint32_t e = offset[v]; e < offset[v + 1]; ++e) {
      const std::uint32_t w = around[e];
      const double bound = length[v] + kGrowth * (mesh.position[w] - mesh.position[v]).norm();
      if (bound >= length[w]) continue;
      length[w] = bound;
      queue.emplace(bound, w);
    }
  };
  // Each edge has one direction in either of its triangles: going out covers both.
  for (std::uint32_t v = 0; v < mesh.position.size(); ++v) lower(v);
  while (!queue.empty()) {
    const auto [bound, v] = queue.top();
    queue.pop();
    if (bound <= length[v]) lower(v);
  }
}

double edgeAt(const EdgeLength& edge, double radius) {
  const double longest = 2 * std::numbers::pi * radius / kEdgesAround;
  double length =
      std::clamp(edge.share * radius, std::min(edge.minimum, edge.maximum), edge.maximum);
  length = std::min(length, longest);
  if (const double sag = edge.sag.at(radius); sag > 0)
    length = std::min(length, std::sqrt(8 * radius * sag));
  return length;
}

std::vector<double> vesselRadii(const CaseSurface& surface, const SeparatedField& field) {
  const formats::CenterlineTree& tree = field.source().tree;
  const formats::Neighbours edges(tree);
  std::vector<double> radius(surface.mesh.position.size());
  tbb::parallel_for(std::size_t{0}, radius.size(), [&](std::size_t v) {
    radius[v] = radiusAt(tree, edges, surface.mesh.position[v], surface.node[v]);
  });
  return radius;
}

std::vector<double> targetLengths(const CaseSurface& surface, const SeparatedField& field,
                                  const EdgeLength& edge) {
  std::vector<double> length = vesselRadii(surface, field);
  for (double& l : length) l = edgeAt(edge, l);
  gradeLengths(surface.mesh, length);
  return length;
}

namespace {

// The factor by which the search for an edge that is enough proceeds.
constexpr double kLongerEdge = 1.1, kLongestEdge = 1e15;

// Length of vessel between a node and its parent, mm.
double lengthToParent(const formats::CenterlineTree& tree, std::size_t node) {
  const std::int32_t parent = tree.parent[node];
  if (parent < 0) return tree.height[node];
  const Eigen::Vector3d from = toEigen(tree.centre[static_cast<std::size_t>(parent)]);
  return (toEigen(tree.centre[node]) - from).norm();
}

EdgeLength longer(EdgeLength edge, double factor) {
  edge.share *= factor;
  edge.minimum *= factor;
  edge.maximum *= factor;
  return edge;
}

// A length rounded up to two digits.
std::string roundedUp(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return shownNumber(std::ceil(value / unit) * unit, 12);
}

}  // namespace

double expectedTriangles(const formats::CenterlineTree& tree, const EdgeLength& edge,
                         const std::optional<Length>& thickness) {
  const double areaInEdges = std::numbers::sqrt3 / 4;  // area of an equilateral triangle
  double triangles = 0;
  for (std::size_t node = 0; node < tree.nodeCount(); ++node) {
    const double radius = tree.radius[node], length = edgeAt(edge, radius);
    const double around = thickness ? 2 * radius + thickness->at(radius) : radius;
    triangles += 2 * std::numbers::pi * around * lengthToParent(tree, node) /
                 (areaInEdges * length * length);
  }
  return triangles;
}

void requireFewTriangles(const formats::CenterlineTree& tree, const EdgeLength& edge,
                         const std::optional<Length>& thickness) {
  const double expected = expectedTriangles(tree, edge, thickness);
  if (expected <= kMaxSurfaceTriangles) return;
  const std::string found =
      "the surface would have about " + shownNumber(expected, 2) + " triangles, which take " +
      shownNumber(std::max(1.0, expected * kBytesPerTriangle / 1e9), 2) +
      " GB while it is made; expected at most " + shownNumber(kMaxSurfaceTriangles, 2) + ": ";
  EdgeLength withoutSag = edge;
  withoutSag.sag = {};
  if (expectedTriangles(tree, withoutSag, thickness) <= kMaxSurfaceTriangles)
    throw invalidInput(found + "a thicker wall has longer edges");
  // the bound in mm makes edges short, unless they are as short without it
  EdgeLength shareAlone = withoutSag;
  shareAlone.maximum = std::numeric_limits<double>::infinity();
  const bool isShare =
      edge.share > 0 && expectedTriangles(tree, shareAlone, thickness) > kMaxSurfaceTriangles;
  double factor = 1;
  while (factor < kLongestEdge &&
         expectedTriangles(tree, longer(withoutSag, factor), thickness) > kMaxSurfaceTriangles)
    factor *= kLongerEdge;
  if (factor >= kLongestEdge)
    throw invalidInput(found + "the vessels are too long for their width");
  throw invalidInput(
      found + "an edge of " +
      (isShare ? roundedUp(factor * edge.share) + "r" : roundedUp(factor * edge.maximum) + " mm") +
      " or more");
}

}  // namespace lumen::convert
