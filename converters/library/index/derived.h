// SPDX-License-Identifier: Apache-2.0
// Restatement of a library for readers who do not know its format: the tag files of its bag and its
// RO-Crates. All follows from library.json and the records, so the writer and the checker of a
// library make them by this.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"

namespace lumen::convert {

inline constexpr const char* kManifestFile = "manifest-sha256.txt";
inline constexpr const char* kTagManifestFile = "tagmanifest-sha256.txt";
inline constexpr const char* kBagFile = "bagit.txt";
inline constexpr const char* kBagInfoFile = "bag-info.txt";
inline constexpr const char* kRootCrate = "data/ro-crate-metadata.json";

/// data/ID/ro-crate-metadata.json: the case as an RO-Crate of its own.
std::string caseCrate(const CaseRecord& record);

/// The files that follow from library.json and the records, but for the crates of the cases.
struct RevisionTexts {
  std::string bag, bagInfo, manifest, tagManifest;
  std::string crate;  ///< data/ro-crate-metadata.json
};

/// Maker of the texts of a library, of which one record at a time is in memory.
class LibraryTexts {
public:
  /// `library` must outlive this.
  explicit LibraryTexts(const LibraryFile& library);

  /// The next case of the library; `crate` is caseCrate(record).
  void add(const LibraryEntry& entry, const CaseRecord& record, std::string_view crate);

  /// After the last case; once only.
  RevisionTexts finish();

private:
  const LibraryFile& m_library;
  RevisionTexts m_texts;
  std::set<std::string> m_licences;
  std::uint64_t m_bytes = 0, m_files = 0;
};

}  // namespace lumen::convert
