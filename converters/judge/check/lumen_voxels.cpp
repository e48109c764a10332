// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/lumen_voxels.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr double kReachRadii = 2;  // limit: a wall farther out belongs to another node

struct Claim {
  std::size_t index;
  double power;
  std::uint32_t node;
};

/// The cells of a box around a ball of radius `reach` mm at `centre`; it may be empty.
CellBox boxAround(const VolumeGeometry& geometry, const Vector3d& centre, double reach) {
  const Vector3d at = geometry.indexFromWorld(centre);
  const Cell last = geometry.cells().high();
  Cell low, high;
  for (int a = 0; a < 3; ++a) {
    const double most = last[a], half = reach / geometry.spacing[a];
    low[a] = static_cast<int>(std::clamp(std::ceil(at[a] - half), 0.0, most + 1));
    high[a] = static_cast<int>(std::clamp(std::floor(at[a] + half), -1.0, most));
  }
  return CellBox::between(low, high);
}

void claimVoxels(const formats::CenterlineTree& tree, const field::BlendedField& surface,
                 const VolumeGeometry& geometry, std::uint32_t node, std::vector<Claim>& claims) {
  const Vector3d centre = toEigen(tree.centre[node]);
  const auto radius = static_cast<double>(tree.radius[node]);
  const double reach = kReachRadii * radius + geometry.voxelSize();
  boxAround(geometry, centre, reach).forEach([&](const Cell& cell) {
    const Vector3d p = geometry.position(cell);
    const double squared = (p - centre).squaredNorm();
    if (squared > reach * reach) return;
    const field::Vec point{p.x(), p.y(), p.z()};
    if (surface.follow(point, node) != node ||
        !(surface.blended(point, node).value > surface.level()))
      return;
    claims.push_back({geometry.index(cell), squared - radius * radius, node});
  });
}

}  // namespace

LumenVoxels::LumenVoxels(const formats::CenterlineTree& tree, const field::BlendedField& surface,
                         const VolumeGeometry& geometry, Progress& progress)
    : m_surface(surface), m_geometry(geometry), m_inside(geometry.voxelCount()) {
  std::vector<std::vector<Claim>> claims(tree.nodeCount());
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t n) {
    progress.check();
    claimVoxels(tree, surface, geometry, static_cast<std::uint32_t>(n), claims[n]);
    progress.advance();
  });
  std::vector<Claim> all;
  for (const auto& some : claims) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end(), [](const Claim& a, const Claim& b) {
    return std::tie(a.index, a.power, a.node) < std::tie(b.index, b.power, b.node);
  });
  for (const Claim& claim : all) {
    if (m_inside[claim.index] != 0) continue;
    m_inside[claim.index] = 1;
    m_voxels.push_back({claim.index, claim.node});
  }
}

std::size_t cornerIndex(const VolumeGeometry& geometry, const Vector3d& at, int corner) {
  const Cell offset(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  return geometry.index((at.cast<int>() + offset).cwiseMin(geometry.cells().high()));
}

std::optional<std::uint32_t> LumenVoxels::nodeAt(std::size_t index) const {
  if (m_inside[index] == 0) return std::nullopt;
  const auto found =
      std::lower_bound(m_voxels.begin(), m_voxels.end(), index,
                       [](const LumenVoxel& v, std::size_t i) { return v.index < i; });
  return found->node;
}

bool LumenVoxels::isInAnother(const Vector3d& point, std::uint32_t own) const {
  const Vector3d at = m_geometry.indexFromWorld(point);
  if (!m_geometry.containsIndex(at)) return false;
  const field::Vec p{point.x(), point.y(), point.z()};
  const std::uint32_t here = m_surface.follow(p, own);
  std::uint32_t before = here;
  for (int corner = 0; corner < 8; ++corner) {
    const auto claimant = nodeAt(cornerIndex(m_geometry, at, corner));
    if (!claimant) continue;
    const std::uint32_t other = m_surface.follow(p, *claimant);
    if (other == here || other == before) continue;
    before = other;
    if (m_surface.blended(p, other).value > m_surface.level()) return true;
  }
  return false;
}

}  // namespace lumen::convert
