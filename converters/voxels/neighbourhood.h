// SPDX-License-Identifier: Apache-2.0
// Mean and spread of the 27 voxels around every voxel of a volume.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/base/progress.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// The cube of three voxels around a voxel, in voxel units. Faces of the volume are repeated.
struct Neighbourhood {
  float mean = 0, deviation = 0;  ///< standard deviation; not finite if a voxel is not
};

namespace neighbourhood_detail {

constexpr float kCube = 27;

/// Sums over threes of voxels, of one slice: of the values and of their squares.
struct SliceSums {
  std::vector<float> across, value, square;  ///< `across`: over slices and rows, for one row

  /// Adds up the three slices around z, voxel by voxel.
  template <class T>
  void take(const std::vector<T>& voxels, const std::array<int, 3>& size, int z, float centre) {
    const std::size_t count = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
    value.assign(count, 0);
    square.assign(count, 0);
    for (int dz = -1; dz <= 1; ++dz) {
      const T* const from =
          voxels.data() + static_cast<std::size_t>(std::clamp(z + dz, 0, size[2] - 1)) * count;
      for (std::size_t i = 0; i < count; ++i) {
        const float at = static_cast<float>(from[i]) - centre;
        value[i] += at;
        square[i] += at * at;
      }
    }
  }

  /// Sums over the cubes around the voxels of a row, in place of `out`.
  void overCubes(const std::vector<float>& slice, const std::array<int, 3>& size, int y,
                 std::vector<float>& out) {
    const auto nx = static_cast<std::size_t>(size[0]);
    const auto row = [&](int at) {
      return slice.data() + static_cast<std::size_t>(std::clamp(at, 0, size[1] - 1)) * nx;
    };
    const float *a = row(y - 1), *b = row(y), *c = row(y + 1);
    across.resize(nx + 2);
    for (std::size_t x = 0; x < nx; ++x) across[x + 1] = a[x] + b[x] + c[x];
    across[0] = across[1];
    across[nx + 1] = across[nx];
    out.resize(nx);
    for (std::size_t x = 0; x < nx; ++x) out[x] = across[x] + across[x + 1] + across[x + 2];
  }
};

}  // namespace neighbourhood_detail

/// Calls visit(index, neighbourhood) for every voxel, slices in parallel. `centre`: an intensity
/// near those that matter, so that their squares keep their digits. Throws Error(Cancelled).
template <class Visit>
void forEachNeighbourhood(const Volume& volume, float centre, const Progress& progress,
                          const Visit& visit) {
  using neighbourhood_detail::kCube;
  using neighbourhood_detail::SliceSums;
  const std::array<int, 3>& size = volume.geometry.size;
  const CellBox cells = volume.geometry.cells();
  tbb::enumerable_thread_specific<SliceSums> workspaces;
  std::visit(
      [&](const auto& voxels) {
        tbb::parallel_for(0, size[2], [&](int z) {
          progress.check();
          SliceSums& sums = workspaces.local();
          sums.take(voxels, size, z, centre);
          std::vector<float> value, square;
          for (int y = 0; y < size[1]; ++y) {
            sums.overCubes(sums.value, size, y, value);
            sums.overCubes(sums.square, size, y, square);
            const std::size_t first = cells.index(Cell(0, y, z));
            for (std::size_t x = 0; x < value.size(); ++x) {
              const float mean = value[x] / kCube;
              const float spread = (square[x] - value[x] * mean) / (kCube - 1);
              visit(first + x, Neighbourhood{centre + mean, std::sqrt(std::max(spread, 0.0F))});
            }
          }
        });
      },
      volume.voxels);
}

}  // namespace lumen::convert
