// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/wall_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {

namespace {

// Voxels: standard deviation of a wall's mean place after tracking and fitting a blurred image.
constexpr double kSharedVoxels = 0.04;
constexpr double kSigmaOfMedian = 1.4826;  // of a normal distribution's median of absolute values
constexpr double kLeastCount = 3;
constexpr double kSupportRadii = 0.5;  // along the vessel, of the points that a section rests on
constexpr double kOfPlace = 4;         // parts of a ring that bend on their own

double spacingAt(const formats::CenterlineTree& tree, std::uint32_t node) {
  const formats::Branch& branch = tree.branches[tree.branch[node]];
  const std::uint32_t last = branch.firstNode + branch.nodeCount - 1;
  const std::uint32_t a = node > branch.firstNode ? node - 1 : node;
  const std::uint32_t b = node < last ? node + 1 : node;
  if (a == b) return double{tree.radius[node]};
  return (toEigen(tree.centre[b]) - toEigen(tree.centre[a])).norm() / (b - a);
}

}  // namespace

WallNoise::WallNoise(const formats::Case& source, const Wall& wall) {
  if (!source.points || source.points->position.empty()) return;
  const formats::CenterlineTree& tree = source.tree;
  const std::size_t count = tree.nodeCount();
  const double voxel = source.metadata.voxelSize.value_or(0);
  m_shared = kSharedVoxels * voxel;
  std::vector<double> variance(count, 0), points(count, 0), spacing(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t n) {
    const auto node = static_cast<std::uint32_t>(n);
    spacing[n] = spacingAt(tree, node);
    const auto& offset = source.points->offset;
    std::vector<Eigen::Vector3d> own;
    for (std::uint32_t p = offset[n]; p < offset[n + 1]; ++p)
      own.push_back(toEigen(source.points->position[p]));
    if (own.empty()) return;
    std::vector<double> distance;
    wall.distances(own, node, distance);
    for (double& d : distance) d = std::abs(d);
    const double sigma = kSigmaOfMedian * upperMedian(distance);
    variance[n] = sigma * sigma;
    // points in one voxel err alike
    const double wallArea = 2 * std::numbers::pi * double{tree.radius[n]} * spacing[n];
    const double voxels = voxel > 0 ? wallArea / (voxel * voxel) : static_cast<double>(own.size());
    points[n] = std::min(static_cast<double>(own.size()), voxels);
  });
  m_variance.assign(count, 0);
  m_count.assign(count, 0);
  for (std::uint32_t n = 0; n < count; ++n) {
    const formats::Branch& branch = tree.branches[tree.branch[n]];
    const double reach = kSupportRadii * double{tree.radius[n]};
    const auto side =
        static_cast<std::uint32_t>(std::clamp(reach / std::max(spacing[n], 1e-6), 1.0, 50.0));
    const std::uint32_t first = n - std::min(side, n - branch.firstNode);
    const std::uint32_t last = std::min(n + side, branch.firstNode + branch.nodeCount - 1);
    double sum = 0;
    for (std::uint32_t k = first; k <= last; ++k) {
      sum += points[k] * variance[k];
      m_count[n] += points[k];
    }
    m_variance[n] = m_count[n] > 0 ? sum / m_count[n] : 0;
  }
}

double WallNoise::ofMean(std::uint32_t node) const {
  if (!isKnown() || m_count[node] < kLeastCount) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(m_variance[node] / m_count[node] + m_shared * m_shared);
}

double WallNoise::ofPlace(std::uint32_t node) const {
  if (!isKnown() || m_count[node] < kLeastCount) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(kOfPlace * m_variance[node] / m_count[node] + m_shared * m_shared);
}

}  // namespace lumen::convert
