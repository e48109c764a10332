// SPDX-License-Identifier: Apache-2.0
// Values between the centres of voxels.
#pragma once

#include <Eigen/Core>

#include "converters/voxels/cell_box.h"

namespace lumen::convert {

/// The value at a position in index space, trilinear between those of the cells around it, of which
/// `valueAt(cell)` gives one; beyond the outermost cells, theirs.
template <class ValueAt>
double trilinear(const CellBox& cells, const Eigen::Vector3d& position, const ValueAt& valueAt) {
  const Eigen::Vector3d at =
      position.cwiseMax(cells.low.cast<double>()).cwiseMin(cells.high().cast<double>());
  const Cell low = at.array().floor().cast<int>().matrix();
  const Eigen::Vector3d share = at - low.cast<double>();
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Cell step(corner & 1, corner >> 1 & 1, corner >> 2);
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= step[a] != 0 ? share[a] : 1 - share[a];
    if (weight > 0) sum += weight * static_cast<double>(valueAt(low + step));
  }
  return sum;
}

}  // namespace lumen::convert
