// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/surface_size.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
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
