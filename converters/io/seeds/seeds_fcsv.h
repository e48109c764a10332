// SPDX-License-Identifier: Apache-2.0
// The fiducials of 3D Slicer before version 5: comma-separated values. Private to the sources of
// seeds.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// One vessel for each row, in file order, not yet checked across branches; `stem` labels rows
/// without a label. Throws Error(InvalidInput) with `file`, the line and the column.
std::vector<SeedBranch> parseFcsv(std::string_view text, const std::filesystem::path& file,
                                  const std::string& stem, const SeedReading& reading);

}  // namespace lumen::convert
