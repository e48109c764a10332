// SPDX-License-Identifier: Apache-2.0
// A change of a library in one step: a reader finds the library of before or that of after,
// whenever the change is killed.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/library/library_file.h"
#include "converters/library/library_lock.h"
#include "converters/library/record.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

/// One new revision of a library.
class LibraryChange {
public:
  /// Holds the library's lock from here on. Throws as openLibrary() and LibraryLock(), and
  /// Error(InvalidInput) for a library whose ids are not in order.
  LibraryChange(const std::filesystem::path& library, Progress& progress);

  /// The library before the change.
  [[nodiscard]] const LibraryFile& library() const { return m_library; }

  /// The case is to be in the library, in place of one with its id. `files` is a folder with
  /// record.files in it, as they are recorded, which stays until commit() and is not changed.
  /// Throws Error(InvalidInput) for a missing statement (missingStatement()) and for two cases of
  /// one id.
  void addOrReplace(CaseRecord record, std::filesystem::path files);
  /// Throws Error(Usage) if there is none of this id.
  void remove(const std::string& id);

  /// Writes the next revision, of the day `date`, and puts it in place of the old one; once only.
  /// The signature and the pages are those of the old one, and go with it. Throws
  /// Error(InvalidInput), and changes nothing, for records that do not match library.json;
  /// Error(Failed) if something cannot be written; Error(Cancelled).
  void commit(const std::string& date);

  /// Files that the old revision had and the new one lacks, relative to the library, after
  /// commit(): its signatures and pages, and files of cases that were replaced.
  [[nodiscard]] const std::vector<std::string>& gone() const { return m_gone; }

private:
  struct Incoming {
    CaseRecord record;
    std::filesystem::path files;
  };
  LibraryEntry writeCase(Incoming& incoming, const std::filesystem::path& data,
                         const std::string& date) const;

  std::filesystem::path m_folder;
  Progress& m_progress;
  LibraryLock m_lock;
  LibraryFile m_library;
  std::map<std::string, Incoming> m_incoming;
  std::set<std::string> m_removed;
  std::vector<std::string> m_gone;
};

/// Throws Error(Usage) if the library has a case of this id.
void requireNewId(const LibraryFile& library, const std::string& id);

/// The case of this id. Throws Error(Usage) if the library has none.
const LibraryEntry& requireCase(const LibraryFile& library, const std::string& id);

/// A hidden folder with an empty data/ that becomes a new library; `library` gets revision 1 and
/// its generator. Throws as makeLibrary().
formats::PendingFolder newLibraryFolder(const std::filesystem::path& folder, LibraryFile& library);

/// A new library without cases, at revision 1; `library` has its id, texts, licence and date.
/// Throws Error(InvalidInput) for a licence that is none, and Error(Failed) where there is
/// something already.
void makeLibrary(const std::filesystem::path& folder, LibraryFile library);

/// Makes the library `to` at revision 1 from the cases `ids` of `from`: their records and files
/// byte for byte. `library` gives its id, texts, licence and date; its origin becomes the revision
/// of `from`. Throws Error(Usage) for an id that `from` lacks, Error(InvalidInput) for a file that
/// is not the one that its record states, Error(Failed) where something exists already,
/// Error(Cancelled). Returns the new library.
LibraryFile extractCases(const std::filesystem::path& from, const std::filesystem::path& to,
                         const std::vector<std::string>& ids, LibraryFile library,
                         Progress& progress);

/// The record of a case. Throws Error(InvalidInput) if it is not what the entry states, with the
/// advice to check.
CaseRecord openRecord(const std::filesystem::path& library, const LibraryEntry& entry);

}  // namespace lumen::convert
