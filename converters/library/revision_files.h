// SPDX-License-Identifier: Apache-2.0
// The folder of a revision of a library while it is made.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "converters/base/files.h"
#include "converters/library/derived.h"
#include "converters/library/library_file.h"
#include "converters/library/record.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

inline constexpr const char* kGenerator = "lumen " LUMEN_VERSION;

/// A hidden folder that becomes `folder`. Throws Error(Failed).
formats::PendingFolder pendingFolder(const std::filesystem::path& folder,
                                     formats::PendingFolder::Existing existing);
/// Puts it in place. Throws Error(Failed).
void commitFolder(formats::PendingFolder& pending);

/// Gives a file a second name, or copies it where the file system has no links. Throws
/// Error(Failed).
void linkFile(const std::filesystem::path& from, const std::filesystem::path& to);

/// Makes a folder with the permissions of another.
void makeFolderLike(const std::filesystem::path& from, const std::filesystem::path& to);

/// Links everything below `from` below `to`, which exists, except entries of `from` itself that
/// `skips` names and files that a killed writer left there. Throws Error(InvalidInput) for a device
/// or a pipe, Error(Failed) otherwise.
void linkAll(const std::filesystem::path& from, const std::filesystem::path& to,
             const std::function<bool(const std::string& name)>& skips = {});

/// Links a case that stays as it is. `crate`: caseCrate() of its record, which replaces the crate
/// of another version of lumen.
void keepCase(const std::filesystem::path& from, const std::filesystem::path& to,
              const std::string& crate);

/// Writes the files of a revision except those of its cases: library.json and all that follows from
/// it and the records.
class RevisionWriter {
public:
  /// `library` must outlive this object.
  RevisionWriter(const std::filesystem::path& folder, const LibraryFile& library);
  /// The next case of the library. `crate`: caseCrate() of its record.
  void add(const CaseRecord& record, const std::string& crate) { m_texts.add(record, crate); }
  /// After the last case.
  void finish();

private:
  std::filesystem::path m_folder;
  const LibraryFile& m_library;
  NewFile m_manifest, m_crate;
  LibraryTexts m_texts;
};

}  // namespace lumen::convert
