// SPDX-License-Identifier: Apache-2.0
// Cases on their way into a library, and changes of it in one step: a reader finds the library of
// before or that of after, whenever the change is killed.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/progress.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/library_lock.h"
#include "converters/library/index/record.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

/// A hidden folder that becomes `folder`. Throws Error(Failed).
formats::PendingFolder pendingFolder(const std::filesystem::path& folder,
                                     formats::PendingFolder::Existing existing);
/// Puts it in place. Throws Error(Failed).
void commitFolder(formats::PendingFolder& pending);

/// Gives a file a second name, or copies it where the file system has no links. Throws
/// Error(Failed).
void linkFile(const std::filesystem::path& from, const std::filesystem::path& to);

/// The files of a case, hidden beside the library until a change puts them in; they go with this
/// object if none does.
class IncomingCase {
public:
  /// Throws Error(Failed) if nothing can be written beside `library`, which need not exist.
  explicit IncomingCase(const std::filesystem::path& library);

  /// Writes a file and records it. `path` as record.files has it, not one that is there. `target`:
  /// of an export. Throws Error(InvalidInput) for a path that a library may not have, Error(Failed)
  /// if it cannot be written.
  void add(const std::string& path, const std::string& role, std::string_view bytes,
           const std::string& target = "");
  /// Copies the file `source` into the case and records it. Throws Error(InvalidInput) for a path
  /// that a library may not have, Error(Failed) if it cannot be copied.
  void addFile(const std::string& path, const std::string& role,
               const std::filesystem::path& source);

  /// The record of the case. Its files are recorded by add(); version and date are the library's to
  /// set.
  CaseRecord record;

  /// The folder of the files.
  [[nodiscard]] std::filesystem::path folder() const { return m_workspace.path() / "case"; }

private:
  std::filesystem::path newPath(const std::string& path) const;
  void note(const std::string& path, const std::string& role, const std::string& target);

  formats::PendingFolder m_workspace;
};

/// Media type by the ending of a file's name; "application/octet-stream" for one that is not known.
std::string mediaType(const std::string& path);

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
