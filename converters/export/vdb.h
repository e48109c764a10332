// SPDX-License-Identifier: Apache-2.0
// OpenVDB level sets, where the library was there when lumen was built.
#pragma once

#include <string>

#include "converters/export/distance_grid.h"

namespace lumen::convert {

/// Whether encodeVdb() can.
bool hasVdb();

struct VdbOptions {
  double band = 0;    ///< mm, > 0: half the width of the band of samples that are kept
  double unit = 1;    ///< lengths of the file in mm: 1 or 1000
  bool half = false;  ///< distances of 16 bits
};

/// A level set "distance", negative in the lumen, of the class "level set", whose background is the band; and a grid of
/// integers "branch": of a sample in the lumen the index of its branch and 1, elsewhere 0. Both have a linear transform
/// to positions in LPS. The same grid gives the same bytes. Throws Error(Unsupported) without the library.
std::string encodeVdb(const DistanceGrid& grid, const VdbOptions& options);

}  // namespace lumen::convert
