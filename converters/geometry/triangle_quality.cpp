// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/triangle_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lumen::convert {
namespace {

double nth(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

double leastAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return std::asin(std::min(1.0, std::sqrt(squaredSine(a, b, c))));
}

TriangleQuality triangleQuality(const TriangleMesh& mesh, std::span<const double> target) {
  TriangleQuality quality;
  quality.triangles = mesh.triangle.size();
  std::vector<double> angles, ratios;
  for (const Triangle& t : mesh.triangle) {
    const double angle = leastAngle(mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]);
    angles.push_back(angle * 180 / std::numbers::pi);
    if (angle < kSharpAngle) ++quality.sharp;
    for (std::size_t i = 0; i < 3 && !target.empty(); ++i) {
      const std::uint32_t v = t[i], w = t[(i + 1) % 3];
      if (v < w)
        ratios.push_back((mesh.position[v] - mesh.position[w]).norm() * 2 /
                         (target[v] + target[w]));
    }
  }
  quality.medianAngle = nth(angles, 0.5);
  quality.leastAngle = nth(angles, 0);
  quality.edgeMedian = nth(ratios, 0.5);
  quality.edgeLow = nth(ratios, 0.05);
  quality.edgeHigh = nth(ratios, 0.95);
  return quality;
}

}  // namespace lumen::convert
