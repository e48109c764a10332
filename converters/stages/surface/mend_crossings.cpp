// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/surface/mend_crossings.h"

#include <algorithm>
#include <vector>

#include "converters/geometry/self_intersections.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kMostPairs = 1'000'000;
constexpr int kMostRounds = 8;

std::vector<bool> isOnEnd(const CaseSurface& surface) {
  std::vector<bool> result(surface.mesh.position.size(), false);
  for (std::size_t t = 0; t < surface.mesh.triangle.size(); ++t)
    if (surface.groups[surface.group[t]].kind != FaceKind::Wall)
      for (const std::uint32_t v : surface.mesh.triangle[t]) result[v] = true;
  return result;
}

}  // namespace

std::size_t mendCrossings(CaseSurface& surface, const SheetField& field, Progress& progress) {
  const std::vector<bool> isFixed = isOnEnd(surface);
  progress.begin("crossings", 0);
  for (int round = 0;; ++round) {
    const SelfIntersections found = selfIntersections(surface.mesh, kMostPairs, &progress);
    if (found.pairs.empty() || round == kMostRounds) {
      progress.end();
      return found.pairs.size();
    }
    std::vector<std::uint32_t> moved;
    for (const auto& pair : found.pairs)
      for (const std::uint32_t t : pair)
        for (const std::uint32_t v : surface.mesh.triangle[t])
          if (!isFixed[v]) moved.push_back(v);
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    for (const std::uint32_t v : moved) {
      Eigen::Vector3d& position = surface.mesh.position[v];
      const SheetSample sample = field.at(position, surface.node[v]);
      const double step = std::max(0.25 * field.options().gap, 0.02 * field.radius(sample.node));
      position -= step * sample.gradient;
    }
  }
}

}  // namespace lumen::convert
