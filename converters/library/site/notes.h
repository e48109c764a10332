// SPDX-License-Identifier: Apache-2.0
// Notes below every page: steps to verify the library, and its limits.
#pragma once

#include <string>

#include "converters/library/library_file.h"

namespace lumen::convert {

/// Steps to verify the library, on any system. A page cannot do it: whoever changes a file can
/// change the page.
std::string howToVerify(const LibraryFile& library, const std::string& root,
                        const std::string& signature);

/// The end of every page. `root`, `signature`: as for galleryPage().
std::string footer(const LibraryFile& library, const std::string& root,
                   const std::string& signature);

/// A block of text to copy, with a name for the button that a script adds.
std::string copyable(const std::string& name, const std::string& text);

}  // namespace lumen::convert
