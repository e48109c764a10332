// SPDX-License-Identifier: Apache-2.0
// Libraries on web servers and in object stores: single files of them, each checked by the digest
// that the one above it states (spec/library.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/engine/remote_inputs.h"
#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::engine {

/// The folder of a library whose address a user wrote: that of the folder, of library.json or of
/// index.html.
convert::RemoteAddress libraryAddress(const convert::RemoteAddress& address);

/// library.json. Throws Error(InvalidInput) as convert::readLibrary(), and as
/// RemoteInputs::fetch().
convert::LibraryFile fetchLibrary(const convert::RemoteAddress& library, RemoteInputs& remote);

/// The record of a case. Throws Error(InvalidInput) if it is not what the entry states, and as
/// RemoteInputs::fetch().
convert::CaseRecord fetchRecord(const convert::RemoteAddress& library,
                                const convert::LibraryEntry& entry, RemoteInputs& remote);

/// A file here with the case of that id, for which library.json, its record and case.lumen are
/// fetched and nothing else. Throws as fetchLibrary(), fetchRecord() and convert::requireCase(),
/// and Error(InvalidInput) if the case is not what its record states.
std::filesystem::path fetchLibraryCase(const convert::RemoteAddress& library, const std::string& id,
                                       RemoteInputs& remote);

/// The file of a case in a library that is here, or whose `address` is given. Throws
/// Error(InvalidInput) for a folder that is no library, Error(Usage) for a case that it lacks, and
/// as fetchLibraryCase().
std::filesystem::path caseOfLibrary(const std::filesystem::path& library,
                                    const std::optional<convert::RemoteAddress>& address,
                                    const std::string& id, RemoteInputs& remote);

}  // namespace lumen::engine
