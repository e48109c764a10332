// SPDX-License-Identifier: Apache-2.0
// lumen's own seeds format (spec/seeds.md). Private to the sources of seeds.
#pragma once

#include <string>
#include <vector>

#include "converters/io/seeds/seeds_parse.h"

namespace lumen::convert {

/// `version` of a file of seeds, spec/seeds.md.
inline constexpr int kSeedsVersion = 1;

/// The branches in file order, not yet checked across branches. Throws Error(InvalidInput).
std::vector<SeedBranch> parseSeeds(const JsonPlace& root, const SeedReading& reading);

/// The text of a seeds file, in LPS mm.
std::string seedsText(const std::vector<SeedBranch>& seeds);

}  // namespace lumen::convert
