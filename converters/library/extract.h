// SPDX-License-Identifier: Apache-2.0
// Cases of a library as a library of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/library/library_file.h"

namespace lumen::convert {

/// Makes the library `to` at revision 1 from the cases `ids` of `from`: their records and files
/// byte for byte. `library` gives its id, texts, licence and date; its origin becomes the revision
/// of `from`. Throws Error(Usage) for an id that `from` lacks, Error(InvalidInput) for a file that
/// is not the one that its record states, Error(Failed) where something exists already,
/// Error(Cancelled). Returns the new library.
LibraryFile extractCases(const std::filesystem::path& from, const std::filesystem::path& to,
                         const std::vector<std::string>& ids, LibraryFile library,
                         Progress& progress);

}  // namespace lumen::convert
