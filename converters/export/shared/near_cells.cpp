// SPDX-License-Identifier: Apache-2.0
// Declared in grid_shortcuts.h.
#include <algorithm>
#include <cmath>

#include "converters/base/vectors.h"
#include "converters/export/shared/grid_shortcuts.h"

namespace lumen::convert {

namespace {

constexpr int kSamplesInCell = 4;       // along each axis, or more if there are many samples
constexpr double kMostCells = 1 << 26;  // 64 MB
/// Radii from a node within which its wall lies: kReachRadii, and as much more as the round ends of
/// vessels are beyond their last nodes.
constexpr double kReachOfEnds = 3;

}  // namespace

NearCells::NearCells(const GridSource& source, const Lattice& fine) : m_first(fine.first) {
  int samples = kSamplesInCell;
  const auto cellCount = [&] {
    double count = 1;
    for (const int size : fine.size) count *= (size - 1) / samples + 1;
    return count;
  };
  while (cellCount() > kMostCells) samples *= 2;
  m_edge = samples * fine.spacing;
  for (std::size_t a = 0; a < 3; ++a) m_size[a] = (fine.size[a] - 1) / samples + 1;
  const auto count = static_cast<std::size_t>(cellCount());
  m_isNear.assign(count, 0);
  const formats::CenterlineTree& tree = source.vessels.tree();
  const auto markNode = [&](std::size_t node) {
    mark(toEigen(tree.centre[node]),
         kReachOfEnds * static_cast<double>(tree.radius[node]) + source.band);
  };
  if (source.region)
    for (const std::uint32_t node : *source.region) markNode(node);
  else
    for (std::size_t node = 0; node < tree.nodeCount(); ++node) markNode(node);
}

std::size_t NearCells::indexOf(const std::array<int, 3>& cell) const {
  return (static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(m_size[1]) +
          static_cast<std::size_t>(cell[1])) *
             static_cast<std::size_t>(m_size[0]) +
         static_cast<std::size_t>(cell[0]);
}

std::array<int, 3> NearCells::cellOf(const Eigen::Vector3d& point) const {
  std::array<int, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double at = std::floor((point[axis] - m_first[axis]) / m_edge);
    cell[a] = static_cast<int>(std::clamp(at, 0.0, static_cast<double>(m_size[a] - 1)));
  }
  return cell;
}

void NearCells::mark(const Eigen::Vector3d& centre, double reach) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(reach);
  const std::array<int, 3> begin = cellOf(centre - margin), end = cellOf(centre + margin);
  // rounding of a sample's place moves it by less than this share of a cell
  constexpr double kSlack = 1e-6;
  for (int k = begin[2]; k <= end[2]; ++k)
    for (int j = begin[1]; j <= end[1]; ++j)
      for (int i = begin[0]; i <= end[0]; ++i) {
        const Eigen::Vector3d low = m_first + m_edge * Eigen::Vector3d(i, j, k);
        const Box3d cell{low - Eigen::Vector3d::Constant(kSlack * m_edge),
                         low + Eigen::Vector3d::Constant((1 + kSlack) * m_edge)};
        if (cell.gap(centre).squaredNorm() <= reach * reach) m_isNear[indexOf({i, j, k})] = 1;
      }
}

bool NearCells::contains(const Eigen::Vector3d& point) const {
  return m_isNear[indexOf(cellOf(point))] != 0;
}

GridShortcuts::GridShortcuts(const GridSource& source, const Lattice& lattice, Progress& progress)
    : m_source(source) {
  if (std::isfinite(source.band))
    m_source.near = &m_near.emplace(source, lattice);
  else
    m_source.far = &m_far.emplace(source, lattice, progress);
}

}  // namespace lumen::convert
