// SPDX-License-Identifier: Apache-2.0
// Grids as the bare numbers that lie beside a header of MetaImage (.mhd).
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <string>

#include "converters/export/shared/distance_grid.h"

namespace lumen::convert {

/// The header of a file `raw` beside it, of numbers of `type` ("MET_FLOAT"), x fastest: mm, LPS.
std::string metaImageHeader(const Lattice& lattice, const std::string& type,
                            const std::string& raw);

/// The distances times `factor`, little-endian.
template <class T>
std::string distanceBytes(const DistanceGrid& grid, double factor) {
  static_assert(std::endian::native == std::endian::little, "the file has the machine's numbers");
  std::string bytes(grid.values.size() * sizeof(T), '\0');
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const T value = static_cast<T>(factor * static_cast<double>(grid.values[i].distance));
    std::memcpy(bytes.data() + i * sizeof(T), &value, sizeof(T));
  }
  return bytes;
}

}  // namespace lumen::convert
