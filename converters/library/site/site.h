// SPDX-License-Identifier: Apache-2.0
// The pages of a library: index.html and site/, for people, from disk or from any web server.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "converters/base/progress.h"

namespace lumen::convert {

struct SiteReport {
  std::size_t cases = 0;
  std::size_t pages = 0;    ///< HTML files
  std::uint64_t bytes = 0;  ///< size of index.html and site/
};

/// Makes the pages of the library in `folder` anew, out of library.json and the records, which it
/// reads one at a time; it changes nothing else, so a signature stays good. Equal libraries give
/// equal bytes. The old pages stay until all new ones are there. Throws Error(InvalidInput) for a
/// folder that is no library, and for a record that is missing, breaks its format or is not the one
/// that library.json states; Error(Failed) for a file that cannot be written; Error(Cancelled).
SiteReport writeSite(const std::filesystem::path& folder, Progress& progress);

}  // namespace lumen::convert
