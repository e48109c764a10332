// SPDX-License-Identifier: Apache-2.0
// 3D Slicer Markups as seeds. Private to the sources of seeds.
#pragma once

#include <string>
#include <vector>

#include "converters/io/seeds/seeds_parse.h"

namespace lumen::convert {

/// The branches in file order, not yet checked across branches; `stem` labels a curve without a
/// name. Throws Error(InvalidInput).
std::vector<SeedBranch> parseMarkups(const JsonPlace& root, const std::string& stem,
                                     const SeedReading& reading);

/// The text of a Markups file in LPS mm: a curve for each branch, with its radii as a measurement,
/// and parent and kind in the description of its first point.
std::string markupsText(const std::vector<SeedBranch>& seeds);

}  // namespace lumen::convert
