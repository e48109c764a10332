// SPDX-License-Identifier: Apache-2.0
// Descriptions of control points, for data that 3D Slicer has no field for. Private to the sources
// of seeds.
#pragma once

#include <functional>
#include <string>

#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// Reads "parent=LABEL; kind=aneurysm; radius=2.5" into `branch`, its frame included; words without
/// "=" are remarks. Calls `refuse`, which throws, with the expectation.
void applyDescription(const std::string& text, SeedBranch& branch,
                      const std::function<void(const std::string&)>& refuse);

}  // namespace lumen::convert
