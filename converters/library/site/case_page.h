// SPDX-License-Identifier: Apache-2.0
// The page of one case.
#pragma once

#include <string>

#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::convert {

/// site/case/ID.html. `signature`: the file's name, empty if there is none.
std::string casePage(const LibraryFile& library, const CaseRecord& record,
                     const std::string& signature);

// Sections of a case's page, in case_sections.cpp; each is complete HTML, empty where there is
// nothing to show.

std::string pictureSection(const CaseRecord& record);
std::string factsSection(
    const CaseRecord& record);  ///< figures, and files to open or download at once
std::string statementsSection(const CaseRecord& record);  ///< licence, origin, consent
std::string placesSection(const std::string& heading, const std::string& note,
                          const std::vector<CasePlace>& places, bool kinds);
std::string filesSection(const CaseRecord& record);
std::string citeSection(const LibraryFile& library, const CaseRecord& record);
std::string provenanceSection(const CaseRecord& record);

/// Commands of a shell that fetch all files of the case and compare them with their digests. The
/// address of the library is left to fill in; a script does that where the page came from a server.
std::string fetchCommands(const CaseRecord& record);

}  // namespace lumen::convert
