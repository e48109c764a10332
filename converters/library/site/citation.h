// SPDX-License-Identifier: Apache-2.0
// Citations of a case of a library.
#pragma once

#include <string>
#include <string_view>

#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::convert {

/// One sentence after another: credit, title, version, library, revision, publisher, year, licence,
/// address.
std::string citationText(const LibraryFile& library, const CaseRecord& record);

/// The citation as an entry for BibTeX and biber, in UTF-8, ending in a newline.
std::string citationBibTex(const LibraryFile& library, const CaseRecord& record);

/// Any text as the value of a field in braces: characters that TeX and BibTeX would read as more
/// than a letter are spelt as commands, and braces stay in pairs.
std::string bibTexText(std::string_view text);

}  // namespace lumen::convert
