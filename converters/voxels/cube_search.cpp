// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/cube_search.h"

#include <algorithm>
#include <limits>

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Maximum number of voxels in a search; beyond it, the search has lost its path.
constexpr std::size_t kMostVoxels = std::size_t{1} << 22;

}  // namespace

CubeSearch::CubeSearch(const VolumeGeometry& geometry, const Vector3d& start, double reach)
    : m_geometry(geometry), m_start(start) {
  const Vector3d at = geometry.indexFromWorld(start);
  const Vector3d half = (reach / geometry.spacing.array()).matrix();
  m_box = geometry.cellsAround(at - half, at + half);
  if (m_box.count() > kMostVoxels) return;
  m_first = voxelAt(start);
  if (isPossible()) m_paths = CheapestPaths(m_box.count());
}

std::size_t CubeSearch::voxelAt(const Vector3d& world) const {
  const auto cell = m_box.nearest(m_geometry.indexFromWorld(world));
  return cell ? m_box.index(*cell) : kNowhere;
}

std::vector<std::size_t> CubeSearch::voxelsIn(const WorldBall& ball) const {
  const Vector3d middle = m_geometry.indexFromWorld(ball.centre) - m_box.low.cast<double>();
  const Vector3d half = ball.radius * m_geometry.spacing.cwiseInverse();
  const Vector3d last = (m_box.size - Cell::Ones()).cast<double>();
  const Vector3d low = (middle - half).cwiseMax(0.0), high = (middle + half).cwiseMin(last);
  if ((low.array() > high.array()).any()) return {};
  const Cell from = m_box.low + low.array().ceil().cast<int>().matrix(),
             to = m_box.low + high.array().floor().cast<int>().matrix();
  std::vector<std::size_t> voxels;
  CellBox::between(from, to).forEach([&](const Cell& cell) {
    if ((m_geometry.position(cell) - ball.centre).norm() <= ball.radius)
      voxels.push_back(m_box.index(cell));
  });
  return voxels;
}

std::vector<CubeSearch::Step> CubeSearch::steps() const {
  const auto nx = static_cast<std::ptrdiff_t>(m_box.size[0]),
             ny = static_cast<std::ptrdiff_t>(m_box.size[1]);
  std::vector<Step> steps;
  CellBox::between(-Cell::Ones(), Cell::Ones()).forEach([&](const Cell& step) {
    if (step.isZero()) return;
    const double length = step.cast<double>().cwiseProduct(m_geometry.spacing).norm();
    steps.push_back(
        {step, (step[2] * ny + step[1]) * nx + step[0], static_cast<float>(0.5 * length)});
  });
  return steps;
}

std::vector<Vector3d> CubeSearch::pathTo(std::size_t voxel) const {
  std::vector<Vector3d> points;
  for (std::size_t at = voxel; at != m_first; at = before(at)) points.push_back(position(at));
  points.push_back(m_start);
  std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace lumen::convert
