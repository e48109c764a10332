// SPDX-License-Identifier: Apache-2.0
// Cases that other processes made in the folder for work, put into the library in one step.
#pragma once

#include <filesystem>
#include <vector>

#include "converters/library/build.h"

namespace lumen::convert {

/// Puts every case whose note states that it was made into the library, as one revision, and makes
/// none. A row that no process made is Failed, with the reason. Results are in the order of the
/// list. Throws as buildLibrary().
std::vector<RowResult> collectRows(const std::vector<BuildRow>& rows,
                                   const std::filesystem::path& library,
                                   const BuildOptions& options, Progress& progress);

}  // namespace lumen::convert
