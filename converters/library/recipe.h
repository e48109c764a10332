// SPDX-License-Identifier: Apache-2.0
// Inputs of a case as one digest: equal recipes give equal cases.
#pragma once

#include <filesystem>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/build_list.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
