// SPDX-License-Identifier: Apache-2.0
// Parts that a mesh lacks of the surface that it was made from.
#pragma once

#include <string>

#include "converters/base/progress.h"
#include "converters/stages/surface/patches/polygonise.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// Warns of branches that have no surface in `file`, and of those with holes: where cells of `cell`
/// mm were too coarse for them, with cells that would do. No loss is reported for a mesh that holds
/// the surface and nothing else.
void reportLosses(const convert::Patches& patches, const std::string& file, double cell,
                  Progress& progress);

/// Warns of parts of a case's tree that a centerline file cannot hold: loops and sacs. `file` is
/// its name.
void reportTreeLosses(const formats::Case& value, const std::string& file, Progress& progress);

}  // namespace lumen::engine
