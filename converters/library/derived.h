// SPDX-License-Identifier: Apache-2.0
// Restatement of a library for readers who do not know its format: the tag files of its bag and its
// RO-Crates. All follows from library.json and the records, so the writer and the checker of a
// library make them by this.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "converters/base/sha256.h"
#include "converters/library/library_file.h"
#include "converters/library/record.h"

namespace lumen::convert {

inline constexpr const char* kManifestFile = "manifest-sha256.txt";
inline constexpr const char* kTagManifestFile = "tagmanifest-sha256.txt";
inline constexpr const char* kBagFile = "bagit.txt";
inline constexpr const char* kBagInfoFile = "bag-info.txt";

/// Receiver of a text, piece by piece.
using TextSink = std::function<void(std::string_view)>;

/// data/ID/ro-crate-metadata.json: the case as an RO-Crate of its own.
std::string caseCrate(const CaseRecord& record);

/// The tag files that do not grow with the cases.
struct TagTexts {
  std::string bag, bagInfo, tagManifest;
};

/// The texts of a whole library, of which one case at a time is in memory.
class LibraryTexts {
public:
  /// `library` must outlive this. `manifest` is given manifest-sha256.txt, `crate`
  /// data/ro-crate-metadata.json.
  LibraryTexts(const LibraryFile& library, TextSink manifest, TextSink crate);

  /// The next case of library.cases. The digest of its record is the one that the library states.
  /// `crate` is caseCrate(record).
  void add(const CaseRecord& record, std::string_view crate);

  /// Passes over the next case, whose record is not there; files that are made of all cases are not
  /// to be had then.
  void skip() { ++m_next; }

  /// After the last case.
  TagTexts finish();

private:
  /// Hands a text on, and keeps its digest and size.
  struct DigestedSink {
    explicit DigestedSink(TextSink receiver) : sink(std::move(receiver)) {}
    void add(std::string_view text);
    TextSink sink;
    Sha256 sum;
    std::uint64_t bytes = 0;
  };

  const LibraryFile& m_library;
  DigestedSink m_manifest, m_crate;
  std::set<std::string> m_licences;
  std::size_t m_next = 0;
  std::uint64_t m_bytes = 0, m_files = 0;
};

}  // namespace lumen::convert
