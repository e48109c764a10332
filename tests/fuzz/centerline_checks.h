// SPDX-License-Identifier: Apache-2.0
// Properties of every centerline that a reader accepts.
#pragma once

#include "converters/io/centerline/centerline_file.h"

namespace lumen::fuzz {

/// Points, chains, and the case that is made of them if their radii allow one.
void checkCenterline(convert::CenterlineFile file, bool hasRadii);

}  // namespace lumen::fuzz
