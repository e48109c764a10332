// SPDX-License-Identifier: Apache-2.0
// Answers of the commands of libraries.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/base/error.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"
#include "converters/library/publish/check_library.h"

namespace lumen::engine {

/// The files that a change left out of a library, as a line of its own; empty if none.
std::string goneText(const std::vector<std::string>& gone);

/// id, revision, title, licence, date, and how many cases there are.
Json librarySummary(const convert::LibraryFile& library);

/// The summary of a library that a command made or changed, the entries that its old revision had
/// alone, and the ids of cases with other statements; no origin.
Json changeJson(const convert::LibraryFile& library, const std::vector<std::string>& gone = {},
                const std::vector<std::string>& updated = {});

/// A case as a line of its library: with the main figures of its record.
Json caseLineJson(const convert::CaseRecord& record, std::uint64_t bytes);

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
