// SPDX-License-Identifier: Apache-2.0
// Interpolation of missing radii in files. Private to the sources of centerline.
#pragma once

#include <string>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// Points without a radius get one interpolated between the nearest points with radius towards the
/// root and away from it, or a copy if only one of these exists; a remark reports their number.
/// Throws Error(InvalidInput) with `name` if no point of some tree has a radius; `expected` states
/// where a file holds radii.
void fillRadii(CenterlineFile& file, const std::string& name, const char* expected);

}  // namespace lumen::convert
