// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/finding/recentre.h"

#include <cstddef>

#include <Eigen/Core>

#include "converters/voxels/trilinear.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kPasses = 8;     // of a step each, and of (1, 2, 1)/4 along the course
constexpr double kStep = 0.4;  // voxels
constexpr double kWide = 2;    // voxels of radius, beyond which ridges say less than depths

class Ridges {
public:
  Ridges(const VolumeGeometry& grid, const ZeroedArray<float>& strength)
      : m_grid(grid), m_cells(grid.cells()), m_strength(strength) {}

  [[nodiscard]] double at(const Vector3d& place) const {
    return trilinear(m_cells, m_grid.indexFromWorld(place),
                     [&](const Cell& cell) { return m_strength[m_cells.index(cell)]; });
  }
  /// The place a step up the ridge from `place`, across `along`; the place itself where none is
  /// higher.
  [[nodiscard]] Vector3d above(const Vector3d& place, const Vector3d& along) const {
    Vector3d up;
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = 0.5 * m_grid.spacing[a] * Vector3d::Unit(a);
      up[a] = (at(place + step) - at(place - step)) / m_grid.spacing[a];
    }
    up -= along.dot(up) * along;
    if (!(up.norm() > 0)) return place;
    const Vector3d next = place + kStep * m_grid.voxelSize() * up.normalized();
    return at(next) > at(place) ? next : place;
  }

private:
  const VolumeGeometry& m_grid;
  CellBox m_cells;
  const ZeroedArray<float>& m_strength;
};

}  // namespace

void recentre(const VolumeGeometry& grid, const ZeroedArray<float>& strength,
              std::vector<SeedPoint>& points) {
  const Ridges ridges(grid, strength);
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<Vector3d> moved;
    for (const SeedPoint& point : points) moved.push_back(point.position);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      if (*points[i].radius > kWide * grid.voxelSize()) continue;
      const Vector3d along = points[i + 1].position - points[i - 1].position;
      moved[i] = ridges.above(points[i].position, along.normalized());
    }
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      points[i].position = 0.25 * (moved[i - 1] + 2 * moved[i] + moved[i + 1]);
  }
}

}  // namespace lumen::convert
