// SPDX-License-Identifier: Apache-2.0
// The gallery of a library, complete without a script, and the list that its script searches.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::convert {

/// Cases on one page, which a phone loads in a second; 10,000 cases take 209 pages.
inline constexpr std::size_t kCasesPerPage = 48;

/// Indices of the library's cases as the gallery lists them: by title, in which numbers count as
/// numbers and small letters as capitals, then by id.
std::vector<std::size_t> galleryOrder(const LibraryFile& library);

/// One case as an item of the list. `root`: as in PageFrame.
std::string galleryCard(const CaseRecord& record, const std::string& root);

/// Number of pages of a gallery of that many cases; at least one.
std::size_t galleryPages(std::size_t cases);

/// Path of page 1, 2, ... in the folder of the library: index.html is the first.
std::string galleryPath(std::size_t page);

/// A page of the gallery. `cards`: the items of its list. `signature`: the file's name, empty if
/// there is none.
std::string galleryPage(const LibraryFile& library, std::size_t page, const std::string& cards,
                        const std::string& signature);

/// A case as an item of the array in site/cases.js: the values that gallery.js searches, counts and
/// draws.
std::string searchRow(const CaseRecord& record);

}  // namespace lumen::convert
