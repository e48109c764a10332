// SPDX-License-Identifier: Apache-2.0
// Rules for the branches of every seeds file. Private to the sources of seeds.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// Branches in file order, checked, with doubled points merged and unit directions, parents first.
/// A parent is another branch, or one of `vessels`. Throws Error(InvalidInput), naming `file` and
/// the label.
std::vector<SeedBranch> checkedSeeds(std::vector<SeedBranch> branches,
                                     const std::filesystem::path& file,
                                     const std::set<std::string>& vessels = {});

}  // namespace lumen::convert
