// SPDX-License-Identifier: Apache-2.0
// Radii where a file has placeholders. Private to the sources of centerline.
#pragma once

#include <string>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// Points without a radius get one in between those of the nearest points towards the root and away
/// from it that have one, or that of the one which there is; a remark says how many. Throws
/// Error(InvalidInput) with `name` if no point of some tree has a radius; `expected` says where a
/// file has them.
void fillRadii(CenterlineFile& file, const std::string& name, const char* expected);

}  // namespace lumen::convert
