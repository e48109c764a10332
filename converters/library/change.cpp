// SPDX-License-Identifier: Apache-2.0
#include "converters/library/change.h"

#include <algorithm>
#include <array>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "converters/base/files.h"
#include "converters/base/option_name.h"
#include "converters/base/sha256.h"
#include "converters/library/revision_files.h"
#include "converters/library/spdx.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using formats::PendingFolder;

std::string shownPath(const fs::path& path) {
  return formats::printable(path.string());
}

fs::path existingFolder(const fs::path& folder) {
  std::error_code error;
  const fs::path path = fs::canonical(folder, error);
  if (error || !fs::is_directory(path, error))
    throw invalidInput(shownPath(folder) + ": there is no such folder, expected a library, which " +
                       "lumen library init makes");
  return path;
}

/// Whether a file is true of one revision alone: it does not come along into the next.
bool isOfOneRevision(const std::string& name) {
  constexpr std::array<std::string_view, 4> kNames = {"library.json.minisig", "library.json.sig",
                                                      "index.html", "site"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

/// Whether a change writes the file anew.
bool isWritten(const std::string& name) {
  constexpr std::array<std::string_view, 6> kNames = {kLibraryFile,  kBagFile,         kBagInfoFile,
                                                      kManifestFile, kTagManifestFile, kPayload};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

/// Files of a version of a case that the next version lacks, as "data/ID/PATH".
std::vector<std::string> missingFrom(const CaseRecord& next, const CaseRecord& before) {
  std::vector<std::string> gone;
  for (const RecordedFile& file : before.files)
    if (std::none_of(next.files.begin(), next.files.end(),
                     [&](const RecordedFile& kept) { return kept.path == file.path; }))
      gone.push_back(std::string(kPayload) + "/" + before.id + "/" + file.path);
  return gone;
}

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

LibraryChange::LibraryChange(const fs::path& library, Progress& progress)
    : m_folder(existingFolder(library)),
      m_progress(progress),
      m_lock(m_folder, progress),
      m_library(openLibrary(m_folder)) {
  for (std::size_t i = 1; i < m_library.cases.size(); ++i)
    if (m_library.cases[i - 1].id >= m_library.cases[i].id)
      throw invalidInput(shownPath(m_folder / kLibraryFile) + ": the ids of its cases are not " +
                         "sorted, or one is there twice; lumen library check reports more");
}

void LibraryChange::addOrReplace(CaseRecord record, fs::path files) {
  const std::string id = record.id;
  if (const std::string fault = missingStatement(record.about); !fault.empty())
    throw invalidInput("case " + id + ": " + fault);
  if (!m_incoming.emplace(id, Incoming{std::move(record), std::move(files)}).second)
    throw invalidInput("two cases of one change have the id " + id);
}

void LibraryChange::remove(const std::string& id) {
  requireCase(m_library, id);
  m_removed.insert(id);
}

LibraryEntry LibraryChange::writeCase(Incoming& incoming, const fs::path& data,
                                      const std::string& date) const {
  CaseRecord& record = incoming.record;
  const LibraryEntry* const before = findCase(m_library, record.id);
  record.version = before == nullptr ? 1 : before->version + 1;
  record.date = date;
  std::sort(record.files.begin(), record.files.end(),
            [](const RecordedFile& a, const RecordedFile& b) { return a.path < b.path; });
  const std::string text = recordText(record);
  readRecord(text, kRecordFile);  // nothing goes in that could not be read
  LibraryEntry entry{
      record.id, record.version, record.about.title, text.size(), sha256(text), record.files.size(),
      0};
  const fs::path folder = data / record.id;
  fs::create_directory(folder);
  for (const RecordedFile& file : record.files) {
    fs::create_directories((folder / file.path).parent_path());
    linkFile(incoming.files / file.path, folder / file.path);
    entry.bytes += file.bytes;
  }
  writeNewFile(text, folder / kRecordFile);
  writeNewFile(caseCrate(record), folder / kCrateFile);
  return entry;
}

void LibraryChange::commit(const std::string& date) {
  LibraryFile next = m_library;
  next.revision += 1;
  next.previous = sha256(readWholeFile(m_folder / kLibraryFile, "list of cases"));
  next.date = date;
  next.generator = kGenerator;
  std::erase_if(next.cases, [this](const LibraryEntry& entry) {
    return m_removed.contains(entry.id) || m_incoming.contains(entry.id);
  });

  PendingFolder pending = pendingFolder(m_folder, PendingFolder::Existing::Replace);
  const fs::path data = pending.path() / kPayload;
  linkAll(m_folder, pending.path(), [this](const std::string& name) {
    if (isOfOneRevision(name)) m_gone.push_back(name);
    return isOfOneRevision(name) || isWritten(name);
  });
  std::sort(m_gone.begin(), m_gone.end());
  makeFolderLike(m_folder / kPayload, data);
  linkAll(m_folder / kPayload, data, [&](const std::string& name) {
    return name == kCrateFile || findCase(m_library, name) != nullptr;
  });
  for (auto& [id, incoming] : m_incoming) {
    next.cases.push_back(writeCase(incoming, data, date));
    if (const LibraryEntry* const before = findCase(m_library, id); before != nullptr)
      for (std::string& file : missingFrom(incoming.record, openRecord(m_folder, *before)))
        m_gone.push_back(std::move(file));
  }
  std::sort(next.cases.begin(), next.cases.end(),
            [](const LibraryEntry& a, const LibraryEntry& b) { return a.id < b.id; });

  RevisionWriter writer(pending.path(), next);
  for (const LibraryEntry& entry : next.cases) {
    m_progress.check();
    const auto incoming = m_incoming.find(entry.id);
    const CaseRecord record =
        incoming != m_incoming.end() ? incoming->second.record : openRecord(m_folder, entry);
    const std::string crate = caseCrate(record);
    if (incoming == m_incoming.end())
      keepCase(m_folder / kPayload / entry.id, data / entry.id, crate);
    writer.add(record, crate);
  }
  writer.finish();
  makeFolderLike(m_folder, pending.path());  // may others look into it as they might before
  commitFolder(pending);
  m_library = std::move(next);
  m_incoming.clear();
  m_removed.clear();
}

void requireNewId(const LibraryFile& library, const std::string& id) {
  if (findCase(library, id) != nullptr)
    throw Error(ErrorKind::Usage, "the library has a case " + id + " already; " +
                                      kOption.replace.shown() +
                                      " puts a better version in its place, " + kOption.id.shown() +
                                      " gives another name");
}

const LibraryEntry& requireCase(const LibraryFile& library, const std::string& id) {
  if (const LibraryEntry* const entry = findCase(library, id)) return *entry;
  throw Error(ErrorKind::Usage, "the library has no case " + formats::printable(id) +
                                    "; lumen library list names its cases");
}

PendingFolder newLibraryFolder(const fs::path& folder, LibraryFile& library) {
  if (const std::string fault = licenceFault(library.licence); !fault.empty())
    throw invalidInput(fault);
  library.revision = 1;
  library.previous.reset();
  library.generator = kGenerator;
  readLibrary(libraryText(library), kLibraryFile);  // nothing is written that could not be read
  std::error_code error;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw failed(shownPath(folder) + ": there is something already; expected a folder that does " +
                 "not exist, or is empty");
  PendingFolder pending = pendingFolder(folder, PendingFolder::Existing::Refuse);
  fs::create_directory(pending.path() / kPayload);
  return pending;
}

void makeLibrary(const fs::path& folder, LibraryFile library) {
  library.cases.clear();
  PendingFolder pending = newLibraryFolder(folder, library);
  RevisionWriter writer(pending.path(), library);
  writer.finish();
  commitFolder(pending);
}

CaseRecord openRecord(const fs::path& library, const LibraryEntry& entry) {
  const fs::path file = library / kPayload / entry.id / kRecordFile;
  std::error_code error;
  const std::string text =
      fs::is_regular_file(fs::symlink_status(file, error)) ? readWholeFile(file, "record") : "";
  if (text.size() != entry.recordBytes || sha256(text) != entry.recordSha256)
    throw invalidInput(shownPath(file) + ": is missing, or is not what " + kLibraryFile +
                       " states; lumen library check reports more");
  CaseRecord record = readRecord(text, file);
  if (record.id != entry.id)
    throw invalidInput(shownPath(file) + ": found the id " + record.id + ", expected " + entry.id);
  return record;
}

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
  commitFolder(pending);
  return library;
}

}  // namespace lumen::convert
