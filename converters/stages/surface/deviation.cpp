// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include "converters/geometry/triangle_tree.h"

namespace lumen::convert {
namespace {

constexpr int kMostParts = 64;  // parts of an edge
constexpr double kDenser = 3;   // points that measure, than those that decide

// Calls visit(point) for the points of a triangle whose edges are divided into `parts`, and for its
// middle if it is none of them, until it returns false; without corners. True if it never did.
template <class Visit>
bool eachPoint(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               int parts, const Visit& visit) {
  const Eigen::Vector3d u = (b - a) / parts, v = (c - a) / parts;
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; i + j <= parts; ++j) {
      const bool isCorner = (i == 0 || i == parts) && (j == 0 || j == parts);
      if (!isCorner && !visit(Eigen::Vector3d(a + i * u + j * v))) return false;
    }
  return parts % 3 == 0 || visit(Eigen::Vector3d((a + b + c) / 3));
}

double longestEdge(const TriangleMesh& mesh, const Triangle& t) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i)
    square = std::max(square, (mesh.position[t[i]] - mesh.position[t[(i + 1) % 3]]).squaredNorm());
  return std::sqrt(square);
}

int countSteps(double length, double spacing) {
  return std::clamp(static_cast<int>(std::ceil(length / spacing)), 2, kMostParts);
}

// The greatest distance of points of one surface from another, mm.
double farthest(const TriangleMesh& from, const std::vector<std::uint32_t>& group,
                const std::vector<bool>& isFree, const TriangleMesh& to) {
  const TriangleTree tree(to);
  std::vector<double> most(from.triangle.size(), 0);
  tbb::parallel_for(std::size_t{0}, most.size(), [&](std::size_t f) {
    if (isFree[group[f]]) return;
    const Triangle& t = from.triangle[f];
    const auto &a = from.position[t[0]], &b = from.position[t[1]], &c = from.position[t[2]];
    const NearestPoint middle = tree.nearest((a + b + c) / 3);
    const double finest = longestEdge(to, to.triangle[middle.triangle]);
    const auto look = [&](const Eigen::Vector3d& p) {
      most[f] = std::max(most[f], tree.nearest(p).distance);
      return true;
    };
    const double longest = longestEdge(from, t);
    for (const auto& corner : {a, b, c}) look(corner);
    eachPoint(a, b, c, countSteps(kDenser * longest, std::min(longest, finest)), look);
  });
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

}  // namespace

double distanceBetween(const TriangleMesh& one, const std::vector<std::uint32_t>& groupOfOne,
                       const TriangleMesh& other, const std::vector<std::uint32_t>& groupOfOther,
                       const std::vector<bool>& isFree) {
  return std::max(farthest(one, groupOfOne, isFree, other),
                  farthest(other, groupOfOther, isFree, one));
}

}  // namespace lumen::convert
