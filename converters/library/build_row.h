// SPDX-License-Identifier: Apache-2.0
// One row of a list, made in a folder of its own. Private to the sources of build.
#pragma once

#include <filesystem>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/build.h"
#include "converters/library/library_file.h"
#include "converters/library/recipe.h"

namespace lumen::convert {

/// A row, its recipe, and its place.
struct PlannedRow {
  const BuildRow* row = nullptr;
  Recipe recipe;
  std::string id;
  std::filesystem::path folder;     ///< the tree's, so that another export does not track again
  std::filesystem::path staged;     ///< a library of this case alone, when it is made
  std::filesystem::path corrected;  ///< an earlier version with corrections to make again; or empty
};

/// Digests of all that the row's case comes from, read whole.
PlannedRow planRow(const BuildRow& row, const LibraryFile& library, const BuildOptions& options,
                   const Progress& progress);

/// Whether `staged` is complete.
bool isStaged(const PlannedRow& plan);

/// Runs lumen until `staged` is complete; continues with the files that are there. Throws
/// Error(Cancelled); any other failure is in the result.
RowResult makeRow(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options,
                  const Progress& progress);

}  // namespace lumen::convert
