// SPDX-License-Identifier: Apache-2.0
// Contents of a library: library.json (spec/library.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

/// A case of a library, with facts that its record must match.
struct LibraryEntry {
  std::string id;
  std::uint32_t version = 1;
  std::string title;
  std::uint64_t recordBytes = 0;
  std::string recordSha256;
  std::uint64_t files = 0, bytes = 0;  ///< number and size of the files in the record
};

/// The revision of another library that cases were extracted from.
struct LibraryOrigin {
  std::string id;  ///< UUID
  std::uint64_t revision = 1;
  std::string sha256;  ///< digest of its library.json
};

struct LibraryFile {
  std::string id;  ///< UUID
  std::uint64_t revision = 1;
  std::optional<std::string> previous;  ///< SHA-256 of library.json of the revision before
  std::optional<LibraryOrigin> origin;  ///< origin of a library that lumen library extract made
  std::string title, description, publisher;
  std::string licence;  ///< an SPDX expression
  std::string date;     ///< YYYY-MM-DD
  std::string generator;
  std::vector<LibraryEntry> cases;  ///< sorted by id
};

inline constexpr const char* kLibraryFile = "library.json";
inline constexpr const char* kCaseFile = "case.lumen";  ///< in the folder of a case
inline constexpr const char* kRecordFile = "record.json";
inline constexpr const char* kCrateFile = "ro-crate-metadata.json";
inline constexpr const char* kPayload = "data";

// Files that are true of one revision alone: signatures, and pages.
inline constexpr const char* kMinisignSignatureFile = "library.json.minisig";
inline constexpr const char* kOpenSshSignatureFile = "library.json.sig";
inline constexpr const char* kFirstPage = "index.html";
inline constexpr const char* kSiteFolder = "site";

/// Whether an entry of a library's folder does not come along into the next revision.
bool isOfOneRevision(std::string_view name);

/// The bytes of library.json. Equal libraries give equal bytes.
std::string libraryText(const LibraryFile& library);

/// Throws Error(InvalidInput), naming `file`, the place, what was found and what was expected.
/// Rules that a schema cannot state are not checked: ids may be twice there or out of order, the
/// licence may be empty.
LibraryFile readLibrary(const std::string& text, const std::filesystem::path& file);

/// library.json of a folder. Throws Error(InvalidInput) for a folder without one.
LibraryFile openLibrary(const std::filesystem::path& folder);

/// A random id, a UUID of version 4 (RFC 9562).
std::string newLibraryId();

/// The case of that id, or null. The cases are sorted.
const LibraryEntry* findCase(const LibraryFile& library, const std::string& id);

}  // namespace lumen::convert
