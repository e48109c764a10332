// SPDX-License-Identifier: Apache-2.0
#include "converters/voxels/grid_geometry.h"

#include <cmath>

namespace lumen::convert {
namespace {

constexpr int kDigits = 6;  // of the spacing: floats hold seven

double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) + 1 - kDigits);
  return std::round(value / unit) * unit;
}

}  // namespace

VolumeGeometry gridGeometry(const VolumeGeometry& world) {
  VolumeGeometry grid;
  grid.size = world.size;
  grid.image = world.image;
  for (Eigen::Index a = 0; a < 3; ++a) grid.spacing[a] = rounded(world.spacing[a]);
  return grid;
}

}  // namespace lumen::convert
