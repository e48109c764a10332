// SPDX-License-Identifier: Apache-2.0
// The parts of a case that the page shows.
#pragma once

#include <string>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::viewer {

/// The pack `case` of a valid case (viewer/README.md), with its wall points or without. Throws
/// Error(Cancelled).
std::string casePack(const formats::Case& value, bool withPoints, Progress& progress);

}  // namespace lumen::viewer
