// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/voxel_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Cost of a millimetre at the wall's level, where it rises with the square of what the middle is
/// missed by.
constexpr double kAtWall = 8;
/// Voxels that a search may look at; beyond, it has lost its way.
constexpr std::size_t kMostVoxels = std::size_t{1} << 22;

constexpr float kFar = std::numeric_limits<float>::infinity();

}  // namespace

double VoxelSearch::price(const LumenLevels& levels, double value) {
  const double range = levels.middle - levels.wall;
  const double missed = range != 0 ? (levels.middle - value) / range : 0;
  if (std::isnan(value)) return kBeyondWall;
  if (missed <= 0) return 1;
  return missed < 1 ? 1 + (kAtWall - 1) * missed * missed : kBeyondWall;
}

VoxelSearch::VoxelSearch(const TrackContext& context, const LumenLevels& levels,
                         const Vector3d& start, double reach)
    : m_context(context), m_levels(levels), m_start(start) {
  const VolumeGeometry& geometry = context.volume.geometry();
  const Vector3d at = geometry.indexFromWorld(start);
  std::size_t count = 1;
  for (int a = 0; a < 3; ++a) {
    const double half = reach / geometry.spacing[a];
    const double last = geometry.size[static_cast<std::size_t>(a)] - 1;
    m_low[a] = static_cast<int>(std::clamp(std::floor(at[a] - half), 0.0, last));
    m_size[a] = static_cast<int>(std::clamp(std::ceil(at[a] + half), 0.0, last)) - m_low[a] + 1;
    count *= static_cast<std::size_t>(m_size[a]);
    if (count > kMostVoxels) return;
  }
  m_first = voxelAt(start);
  if (!isPossible()) return;
  m_isDone.assign(count, false);
  m_cost.assign(count, kFar);
  m_price.assign(count, -1.0F);
  m_from.assign(count, 0);
}

bool VoxelSearch::holds(const Vector3i& cell) const {
  return (cell.array() >= 0).all() && (cell.array() < m_size.array()).all();
}

std::size_t VoxelSearch::voxelOf(const Vector3i& cell) const {
  const auto c = cell.cast<std::size_t>(), size = m_size.cast<std::size_t>();
  return (c[2] * size[1] + c[1]) * size[0] + c[0];
}

Vector3i VoxelSearch::cell(std::size_t voxel) const {
  const auto size = m_size.cast<std::size_t>();
  const std::size_t row = voxel / size[0];
  return Eigen::Matrix<std::size_t, 3, 1>(voxel % size[0], row % size[1], row / size[1])
      .cast<int>();
}

std::size_t VoxelSearch::voxelAt(const Vector3d& world) const {
  const Vector3d at = m_context.volume.geometry().indexFromWorld(world);
  if (!at.allFinite() || (at.array().abs() > std::numeric_limits<int>::max() / 2).any())
    return kNowhere;
  const Vector3i cell = at.array().round().cast<int>().matrix() - m_low;
  return holds(cell) ? voxelOf(cell) : kNowhere;
}

Vector3d VoxelSearch::position(std::size_t voxel) const {
  return m_context.volume.geometry().worldFromIndex((cell(voxel) + m_low).cast<double>());
}

bool VoxelSearch::areNeighbours(std::size_t a, std::size_t b) const {
  return (cell(a) - cell(b)).cwiseAbs().maxCoeff() <= 1;
}

std::vector<std::size_t> VoxelSearch::voxelsIn(const Ball& ball) const {
  const VolumeGeometry& geometry = m_context.volume.geometry();
  const Vector3d middle = geometry.indexFromWorld(ball.centre) - m_low.cast<double>();
  const Vector3d half = ball.radius * geometry.spacing.cwiseInverse();
  const Vector3d last = (m_size - Vector3i::Ones()).cast<double>();
  const Vector3d low = (middle - half).cwiseMax(0.0), high = (middle + half).cwiseMin(last);
  if ((low.array() > high.array()).any()) return {};
  const Vector3i from = low.array().ceil().cast<int>(), to = high.array().floor().cast<int>();
  std::vector<std::size_t> voxels;
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y)
      for (int x = from.x(); x <= to.x(); ++x) {
        const std::size_t voxel = voxelOf({x, y, z});
        if ((position(voxel) - ball.centre).norm() <= ball.radius) voxels.push_back(voxel);
      }
  return voxels;
}

float VoxelSearch::priceOf(std::size_t voxel, const Vector3i& cell) {
  if (m_price[voxel] < 0) {
    const double value = m_context.volume.sample((cell + m_low).cast<double>());
    m_price[voxel] = static_cast<float>(price(m_levels, value));
  }
  return m_price[voxel];
}

void VoxelSearch::run(bool stayInside, const std::function<Then(std::size_t, double)>& visit) {
  using Entry = std::pair<float, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  m_cost[m_first] = 0;
  m_from[m_first] = static_cast<std::uint32_t>(m_first);
  queue.push({0.0F, static_cast<std::uint32_t>(m_first)});
  const Vector3d& spacing = m_context.volume.geometry().spacing;
  for (std::size_t taken = 0; !queue.empty(); ++taken) {
    const auto [cost, voxel] = queue.top();
    queue.pop();
    if (m_isDone[voxel]) continue;
    m_isDone[voxel] = true;
    if ((taken & 1023U) == 0) m_context.progress.check();
    const Then then = visit(voxel, cost);
    if (then == Then::Stop) return;
    if (then == Then::GoNoFurther) continue;
    const Vector3i here = cell(voxel);
    const float price = priceOf(voxel, here);
    for (int n = 0; n < 27; ++n) {
      const Vector3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (n == 13 || !holds(here + step)) continue;
      const std::size_t next = voxelOf(here + step);
      if (m_isDone[next]) continue;
      const float nextPrice = priceOf(next, here + step);
      if (stayInside && nextPrice >= static_cast<float>(kBeyondWall)) continue;
      const double length = step.cast<double>().cwiseProduct(spacing).norm();
      const float reached = cost + static_cast<float>(0.5 * length) * (price + nextPrice);
      if (reached >= m_cost[next]) continue;
      m_cost[next] = reached;
      m_from[next] = voxel;
      queue.push({reached, static_cast<std::uint32_t>(next)});
    }
  }
}

std::vector<Vector3d> VoxelSearch::wayTo(std::size_t voxel) const {
  std::vector<Vector3d> points;
  for (std::size_t at = voxel; at != m_first; at = m_from[at]) points.push_back(position(at));
  points.push_back(m_start);
  std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace lumen::convert
