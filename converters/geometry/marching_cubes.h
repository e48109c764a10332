// SPDX-License-Identifier: Apache-2.0
// Iso-surfaces of samples on a regular grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/mesh_measures.h"

namespace lumen::convert {

/// Samples at cell * (x, y, z) of a lattice that is fixed in space. Row (y, z) holds the samples of
/// a range of x of its own, so that a grid need not fill its box.
struct SampleGrid {
  struct SampleRow {
    int first = 0;           ///< x of the row's first sample
    int count = 0;           ///< samples, 0 or more
    std::size_t offset = 0;  ///< index of the row's first sample in `value`
  };

  double cell = 0;         ///< mm
  int lowY = 0, lowZ = 0;  ///< lattice position of row(0, 0)
  int rowsY = 0, rowsZ = 0;
  std::vector<SampleRow> rows;  ///< rowsY * rowsZ, y fastest
  std::vector<double> value;

  [[nodiscard]] const SampleRow& row(int y, int z) const {
    return rows[static_cast<std::size_t>(z) * static_cast<std::size_t>(rowsY) +
                static_cast<std::size_t>(y)];
  }
};

/// State of a sample with respect to the surface.
enum class SampleState : std::uint8_t { Outside, OtherInside, Inside };

/// Marks samples above `level`: Inside those in the connected component of the one nearest to
/// `seed` (mm), OtherInside the rest. Samples are adjacent along the lattice's edges and the
/// diagonals of its faces, as the surface joins them. No sample is Inside if none is within `reach`
/// of `seed`.
std::vector<SampleState> markLumen(const SampleGrid& grid, double level,
                                   const Eigen::Vector3d& seed, double reach);

/// The fraction in (0, 1) of the edge from a to b at which the surface crosses it.
using EdgeCrossing =
    std::function<double(const Eigen::Vector3d& a, double fa, const Eigen::Vector3d& b, double fb)>;

/// Marching cubes around the samples marked Inside. Cells that lack a sample are left out. The
/// result is an oriented 2-manifold, with a boundary only at cells that were left out; no two of
/// its vertices coincide.
TriangleMesh marchingCubes(const SampleGrid& grid, std::span<const SampleState> state,
                           const EdgeCrossing& crossing);

}  // namespace lumen::convert
