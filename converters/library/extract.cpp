// SPDX-License-Identifier: Apache-2.0
#include "converters/library/extract.h"

#include <set>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/sha256.h"
#include "converters/library/change.h"
#include "converters/library/library_lock.h"
#include "converters/library/revision_files.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

/// Copies rather than links: an edit of one library by hand must not reach the other.
void copyFile(const fs::path& from, const fs::path& to, const RecordedFile& stated) {
  fs::create_directories(to.parent_path());
  std::error_code error;
  if (fs::is_regular_file(fs::symlink_status(from, error))) fs::copy_file(from, to, error);
  const bool isThere = !error && fs::exists(to, error);
  const FileDigest digest = isThere ? digestOfFile(to) : FileDigest{};
  if (!isThere || digest.bytes != stated.bytes || digest.sha256 != stated.sha256)
    throw invalidInput(formats::printable(from.string()) + ": is missing, or is not what " +
                       kRecordFile + " states; lumen library check reports more");
  fs::permissions(to, fs::perms::owner_write | fs::perms::owner_read, fs::perm_options::add, error);
}

}  // namespace

LibraryFile extractCases(const fs::path& from, const fs::path& to,
                         const std::vector<std::string>& ids, LibraryFile library,
                         Progress& progress) {
  const LibraryLock lock(from, progress, LibraryLock::Use::Read);
  const LibraryFile source = openLibrary(from);
  library.origin =
      LibraryOrigin{source.id, source.revision, digestOfFile(from / kLibraryFile).sha256};
  library.cases.clear();
  for (const std::string& id : std::set(ids.begin(), ids.end()))
    library.cases.push_back(requireCase(source, id));
  formats::PendingFolder pending = newLibraryFolder(to, library);
  RevisionWriter writer(pending.path(), library);
  for (const LibraryEntry& entry : library.cases) {
    const CaseRecord record = openRecord(from, entry);
    const fs::path folder = from / kPayload / entry.id;
    const fs::path target = pending.path() / kPayload / entry.id;
    fs::create_directory(target);
    for (const RecordedFile& file : record.files) {
      progress.check();
      copyFile(folder / file.path, target / file.path, file);
    }
    const std::string crate = caseCrate(record);
    writeNewFile(readWholeFile(folder / kRecordFile, "record"), target / kRecordFile);
    writeNewFile(crate, target / kCrateFile);
    writer.add(record, crate);
  }
  writer.finish();
  putInPlace(pending);
  return library;
}

}  // namespace lumen::convert
