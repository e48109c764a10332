// SPDX-License-Identifier: Apache-2.0
// The hidden folders in which new files and folders lie until they are complete (atomic_file.h).
#pragma once

#include <filesystem>
#include <string>

#include "formats/case/atomic_file.h"
#include "formats/case/file_descriptor.h"
#include "formats/container/expected.h"

namespace lumen::formats {

inline Issue writeError(const std::filesystem::path& file, const std::string& what, int code) {
  return {ErrorCode::IoWrite, std::nullopt,
          file.string() + ": " + what + ": " + systemErrorText(code)};
}

inline std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// A new hidden folder beside `target`, for a file or folder whose name ends in `ending`.
Expected<HiddenSibling> hiddenSibling(const std::filesystem::path& target,
                                      const std::string& ending);

/// Removes leftovers of killed writers, and folders of such a name that are empty: the writer was
/// killed before or behind its proof. Failures are ignored: the next write tries again.
void removeAbandoned(const std::filesystem::path& folder);

}  // namespace lumen::formats
