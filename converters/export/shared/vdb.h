// SPDX-License-Identifier: Apache-2.0
// OpenVDB level sets, where the library was there when lumen was built.
#pragma once

#include <string>

#include "converters/export/shared/distance_grid.h"

namespace lumen::convert {

/// Throws Error(Unsupported) without the library.
void requireVdb();

struct VdbOptions {
  double unit = 1;    ///< lengths of the file in mm: 1 or 1000
  bool half = false;  ///< distances of 16 bits
};

/// A level set "distance", negative in the lumen, of the class "level set", whose background is the
/// band, which must be finite; and a grid of integers "branch": for a sample in the lumen the index
/// of its branch and 1, elsewhere 0. Both have a linear transform to positions in LPS. Equal
/// samples give equal bytes. Throws as requireVdb(), and Error(Cancelled).
std::string encodeVdb(const GridSource& source, const Lattice& lattice, const VdbOptions& options,
                      Progress& progress);

}  // namespace lumen::convert
