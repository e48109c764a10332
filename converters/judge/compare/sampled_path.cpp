// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/compare/sampled_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

enum Move : std::uint8_t { Both, First, Second };

std::vector<PathSample> takeSamples(const formats::CenterlineTree& tree,
                                    const formats::Branch& branch, bool withLink) {
  std::vector<PathSample> path;
  const auto append = [&](std::uint32_t node, bool onLink) {
    const formats::Vec3f& c = tree.centre[node];
    path.push_back(
        {Vector3d(static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z)),
         static_cast<double>(tree.radius[node]), onLink});
  };
  if (withLink && branch.parentNode != formats::kNoParent)
    append(static_cast<std::uint32_t>(branch.parentNode), true);
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
    append(n, false);
  return path;
}

}  // namespace

SampledPath samplePath(const formats::CenterlineTree& tree, std::uint32_t branch, double step,
                       bool withLink) {
  const std::vector<PathSample> path = takeSamples(tree, tree.branches[branch], withLink);
  if (path.empty()) return {};
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path[i].position - path[i - 1].position).norm();
  const int steps = static_cast<int>(std::ceil(length / step - 1e-9));
  if (steps <= 0) return {{path.back()}, 0};
  SampledPath result;
  result.spacing = length / steps;
  double before = 0;
  std::size_t segment = 1;
  double piece = (path[1].position - path[0].position).norm();
  for (int i = 0; i <= steps; ++i) {
    const double wanted = result.spacing * i;
    while (segment + 1 < path.size() && before + piece < wanted) {
      before += piece;
      ++segment;
      piece = (path[segment].position - path[segment - 1].position).norm();
    }
    const double u = piece > 0 ? std::clamp((wanted - before) / piece, 0.0, 1.0) : 1.0;
    const PathSample &a = path[segment - 1], &b = path[segment];
    result.samples.push_back({a.position + u * (b.position - a.position),
                              a.radius + u * (b.radius - a.radius), a.onLink && u < 1});
  }
  return result;
}

ClosestPoint closestOn(const std::vector<PathSample>& path, const Vector3d& point) {
  if (path.empty()) return {std::numeric_limits<double>::infinity(), 0, 0};
  ClosestPoint best{(point - path[0].position).squaredNorm(), path[0].radius, 0};
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vector3d along = path[i + 1].position - path[i].position, to = point - path[i].position;
    const double squared = along.squaredNorm();
    const double u = squared > 0 ? std::clamp(to.dot(along) / squared, 0.0, 1.0) : 0.0;
    const double distance = (to - u * along).squaredNorm();
    if (distance < best.distance)
      best = {distance, path[i].radius + u * (path[i + 1].radius - path[i].radius), i};
  }
  best.distance = std::sqrt(best.distance);
  return best;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> correspond(const std::vector<PathSample>& a,
                                                                const std::vector<PathSample>& b) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  if (a.empty() || b.empty()) return pairs;
  const std::size_t columns = b.size();
  std::vector<std::uint8_t> moves(a.size() * columns, Both);
  std::vector<double> above(columns), sums(columns);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      double best = i == 0 && j == 0 ? 0 : std::numeric_limits<double>::infinity();
      std::uint8_t move = Both;
      if (i > 0 && j > 0) best = above[j - 1];
      if (i > 0 && above[j] < best) best = above[j], move = First;
      if (j > 0 && sums[j - 1] < best) best = sums[j - 1], move = Second;
      moves[i * columns + j] = move;
      sums[j] = best + (a[i].position - b[j].position).norm();
    }
    std::swap(above, sums);
  }
  std::size_t i = a.size() - 1, j = columns - 1;
  while (true) {
    pairs.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    if (i == 0 && j == 0) break;
    const std::uint8_t move = moves[i * columns + j];
    if (move != Second) --i;
    if (move != First) --j;
  }
  std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace lumen::convert
