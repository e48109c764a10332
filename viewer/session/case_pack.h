// SPDX-License-Identifier: Apache-2.0
// What of a case the page shows.
#pragma once

#include <string>

#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::viewer {

/// The pack `case` of a valid case (viewer/README.md). Throws Error(Cancelled).
std::string casePack(const formats::Case& value, Progress& progress);

}  // namespace lumen::viewer
