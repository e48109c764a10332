// SPDX-License-Identifier: Apache-2.0
// Synthetic vessels that touch, and what a grid says between its samples.
#pragma once

#include <cmath>
#include <cstddef>

#include "../mesh/synthetic.h"
#include "converters/export/shared/distance_grid.h"

namespace lumen::test {

/// Two tubes along x, of radii 1 and 0.6 mm, whose walls are `gap` apart at y = 1: 20 and 12 nodes, 1 mm apart, which no
/// edge joins. The axis of the second lies at y = 1.6 + gap.
inline formats::Case kissingCase(double gap) {
  formats::Case result;
  result.metadata.voxelSize = 0.2;
  addVessel(result, "wide", straightPath({0, 0, 0}, {1, 0, 0}, 20), 1.0, 1.0);
  addVessel(result, "narrow", straightPath({4, 1.6 + gap, 0}, {1, 0, 0}, 12), 0.6, 1.0);
  addModels(result);
  return result;
}

/// Around all of that.
inline convert::Box3d kissingBox() {
  return {{-1.5, -1.5, -1.5}, {20.5, 3, 1.5}};
}

/// Between the eight samples around a place, which is in the grid.
inline double trilinear(const convert::DistanceGrid& grid, const Eigen::Vector3d& p) {
  std::array<std::size_t, 3> cell{};
  std::array<double, 3> share{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double x = (p[axis] - grid.lattice.first[axis]) / grid.lattice.spacing;
    cell[a] = static_cast<std::size_t>(
        std::min(std::floor(x), static_cast<double>(grid.lattice.size[a] - 2)));
    share[a] = x - static_cast<double>(cell[a]);
  }
  double sum = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::size_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t side = corner >> a & 1U;
      weight *= side ? share[a] : 1 - share[a];
      at[a] = cell[a] + side;
    }
    const auto nx = static_cast<std::size_t>(grid.lattice.size[0]),
               ny = static_cast<std::size_t>(grid.lattice.size[1]);
    sum += weight * static_cast<double>(grid.values[(at[2] * ny + at[1]) * nx + at[0]].distance);
  }
  return sum;
}

inline convert::WallDistance askAll(const convert::VesselDistance& vessels,
                                    const Eigen::Vector3d& p) {
  convert::WallDistance answer;
  vessels.ofAll({&p, 1}, 1e9, {&answer, 1});
  return answer;
}

inline convert::WallDistance askBranch(const convert::VesselDistance& vessels,
                                       const convert::TreeRegion& region,
                                       const Eigen::Vector3d& p) {
  convert::WallDistance answer;
  vessels.ofRegion(region, {&p, 1}, 1e9, {&answer, 1});
  return answer;
}

}  // namespace lumen::test
