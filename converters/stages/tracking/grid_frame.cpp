// SPDX-License-Identifier: Apache-2.0
// Declared in tracking_volume.h.
#include <utility>

#include "converters/base/vectors.h"
#include "converters/stages/tracking/tracking_volume.h"
#include "converters/voxels/grid_geometry.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Places of a seed within a voxel along each axis, and the share of their distance by which they
/// are moved, so that no fraction of a voxel by powers of two lies halfway between two of them.
constexpr double kSeedPlaces = 1000, kSeedsMoved = 0.3;

}  // namespace

GridFrame::GridFrame(const VolumeGeometry& world) : m_world(world), m_grid(gridGeometry(world)) {}

std::vector<SeedBranch> GridFrame::toGrid(std::vector<SeedBranch> seeds) const {
  for (SeedBranch& seed : seeds) {
    for (SeedPoint& point : seed.points) {
      const Eigen::Array3d places = kSeedPlaces * m_world.indexFromWorld(point.position).array();
      point.position =
          m_grid.worldFromIndex(((places + kSeedsMoved).round() - kSeedsMoved) / kSeedPlaces);
    }
    if (seed.direction) seed.direction = m_world.direction.transpose() * *seed.direction;
  }
  return seeds;
}

Vector3d GridFrame::toWorld(const Vector3d& point) const {
  return inFrame(m_grid, m_world, point);
}

void GridFrame::toWorld(TrackedBranch& branch) const {
  for (TrackedNode& node : branch.nodes) {
    node.centre = toWorld(node.centre);
    node.direction = (m_world.direction * node.direction).normalized();
    for (formats::Vec3f& point : node.points) point = toVec3f(toWorld(toEigen(point)));
  }
}

}  // namespace lumen::convert
