// SPDX-License-Identifier: Apache-2.0
// Answers of checks of libraries.
#pragma once

#include <string>

#include "converters/base/error.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/library/check_library.h"

namespace lumen::engine {

/// Facts that check and verify have in common: id, title, revision, counts and faults.
Json libraryCheckJson(const std::string& folder, const convert::LibraryCheck& check);

/// A line for each fault, and one with the number of faults that are not listed.
std::string libraryFaultsText(const std::string& folder, const convert::LibraryCheck& check);

/// "revision 7 of "Carotid siphons"", or nothing if library.json could not be read.
std::string libraryName(const convert::LibraryCheck& check);

/// "12 cases, 96 files, 1.5 MB"
std::string checkedText(const convert::LibraryCheck& check);

/// "3 errors and 1 warning"
std::string faultCounts(const convert::LibraryCheck& check);

}  // namespace lumen::engine
