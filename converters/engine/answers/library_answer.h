// SPDX-License-Identifier: Apache-2.0
// Answers of the commands of libraries.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::engine {

/// The files that a change left out of a library, as a line of its own; empty if none.
std::string goneText(const std::vector<std::string>& gone);

/// id, revision, title, licence, date, and how many cases there are.
Json librarySummary(const convert::LibraryFile& library);

/// A case as a line of its library: with the main figures of its record.
Json caseLineJson(const convert::CaseRecord& record, std::uint64_t bytes);

}  // namespace lumen::engine
