// SPDX-License-Identifier: Apache-2.0
// One row of a list, made in a folder of its own. Private to the sources of build and row_note.
#pragma once

#include <filesystem>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"
#include "converters/library/rows/build.h"
#include "converters/library/rows/build_list.h"

namespace lumen::convert {

// Inputs of a case as one digest: equal recipes give equal cases.

/// SHA-256 of an input: of a file; of all files of a folder, with their names; of a header and the
/// files beside it that it names, or names by a pattern, or that are called alike, where it is one
/// of a format that keeps its voxels or vertices apart (.nhdr, .mhd, .hdr, .img, .gltf). Throws
/// Error(Failed) for a file that cannot be read, Error(Cancelled).
std::string digestOfInput(const std::filesystem::path& input, const Progress& progress);

struct Recipe {
  std::string input;  ///< digest
  /// Digest of all inputs of the tree and the models: version, input, seeds, options.
  std::string tree;
  std::string all;  ///< digest of `tree`, statements and exports
};

/// `version`: of lumen. `shared`: facts that all rows have in common, such as the licence of the
/// library.
Recipe makeRecipe(const BuildRow& row, const std::string& version, const std::string& shared,
                  const Progress& progress);

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

/// Whether `staged` is a complete library with the case `id`.
bool isStaged(const std::filesystem::path& staged, const std::string& id);

/// The record of a case in a library. Throws Error(InvalidInput) if it cannot be read.
CaseRecord recordIn(const std::filesystem::path& library, const std::string& id);

/// Whether the library in `folder` has the case `id`, made from the recipe. A record that cannot be
/// read is not.
bool isMadeFrom(const std::filesystem::path& folder, const LibraryFile& library,
                const std::string& id, const std::string& recipe);

/// Whether the row stays as it is because the run is resumed and the library has its id.
bool isResumedRow(const BuildRow& row, const LibraryFile& library, const BuildOptions& options);

/// Rows without an id get one of their input, which two rows may share: the reason why one fails.
std::string inputIsThatOf(std::size_t line);

void warnOfRow(Progress& progress, const RowResult& result);

/// Runs lumen until `staged` is complete; continues with the files that are there. Throws
/// Error(Cancelled); any other failure is in the result.
RowResult makeRow(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options);

}  // namespace lumen::convert
