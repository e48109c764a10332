// SPDX-License-Identifier: Apache-2.0
// Files into the document.
#pragma once

#include <filesystem>
#include <string>

#include "converters/base/progress.h"
#include "converters/cli/options.h"
#include "viewer/session/document.h"

namespace lumen::viewer {

struct Opening {
  std::filesystem::path path;
  std::string label;     ///< what messages call it
  bool dropped = false;  ///< its bytes came from the page, and `path` will be gone
  bool asTruth = false;  ///< a case to compare with
};

/// What the file is, by its content and its name's ending. Throws Error(Unsupported) for what lumen
/// does not read and Error(InvalidInput) for what is not there.
FileRole roleOf(const Opening& opening);

/// The document with the file as well, as number `id`. A volume, a case, a truth or seeds take the
/// place of those that were open; meshes are added. A centerline becomes a case, and is fitted.
/// Throws what its reader throws.
Document withFile(const Document& document, const Opening& opening, int id,
                  const app::VolumeArguments& volume, Progress& progress);

/// The document without that file and what came from it. Throws Error(Usage) if there is none.
Document withoutFile(const Document& document, int id);

}  // namespace lumen::viewer
