// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/change.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/option_name.h"
#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/index/derived.h"
#include "converters/library/index/spdx.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using formats::PendingFolder;

constexpr const char* kGenerator = "lumen " LUMEN_VERSION;

std::string shownPath(const fs::path& path) {
  return formats::printable(path.string());
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
std::error_code copyPlain(const fs::path& from, const fs::path& to) {
  std::error_code error, ignored;
  fs::create_directories(to.parent_path());
  fs::copy_file(from, to, error);
  fs::permissions(to, fs::perms::owner_write | fs::perms::owner_read, fs::perm_options::add,
                  ignored);
  return error;
}

/// A file of a record for another library.
void copyRecorded(const fs::path& from, const fs::path& to, const RecordedFile& stated) {
  std::error_code error;
  const bool isThere = fs::is_regular_file(fs::symlink_status(from, error)) && !copyPlain(from, to);
  const FileDigest digest = isThere ? digestOfFile(to) : FileDigest{};
  if (!isThere || digest.bytes != stated.bytes || digest.sha256 != stated.sha256)
    throw invalidInput(shownPath(from) + ": is missing, or is not what " + kRecordFile +
                       " states; lumen library check reports more");
}

/// Makes a folder with the permissions of another.
void makeFolderLike(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directory(to, error);
  fs::permissions(to, fs::status(from).permissions() | fs::perms::owner_all, error);
}

/// Links everything below `from` below `to`, which exists, except entries of `from` itself that
/// `skips` names and files that a killed writer left there.
void linkAll(const fs::path& from, const fs::path& to,
             const std::function<bool(const std::string& name)>& skips = {}) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(from, error)) {
    const std::string name = entry.path().filename().string();
    const fs::path target = to / name;
    if (formats::isTemporary(entry.path()) || (skips && skips(name))) continue;
    const fs::file_status status = entry.symlink_status();
    if (fs::is_directory(status)) {
      makeFolderLike(entry.path(), target);
      linkAll(entry.path(), target);
    } else if (fs::is_regular_file(status)) {
      linkFile(entry.path(), target);
    } else if (fs::is_symlink(status)) {
      fs::copy_symlink(entry.path(), target);
    } else {
      throw invalidInput(shownPath(entry.path()) + ": found a device or a pipe, expected files");
    }
  }
  if (error) throw failed(shownPath(from) + ": cannot be read: " + error.message());
}

/// Links a case that stays as it is. `crate`: caseCrate() of its record, which replaces the crate
/// of another version of lumen.
void keepCase(const fs::path& from, const fs::path& to, const std::string& crate) {
  makeFolderLike(from, to);
  const fs::path old = from / kCrateFile;
  std::error_code error;
  const bool isSame = fs::is_regular_file(fs::symlink_status(old, error)) &&
                      readWholeFile(old, "RO-Crate") == crate;
  linkAll(from, to, [isSame](const std::string& name) { return !isSame && name == kCrateFile; });
  if (!isSame) writeNewFile(crate, to / kCrateFile);
}

/// Writes the files of a revision except those of its cases.
void writeRevision(const fs::path& folder, const LibraryFile& library, LibraryTexts& texts) {
  const RevisionTexts made = texts.finish();
  writeNewFile(made.manifest, folder / kManifestFile);
  writeNewFile(made.crate, folder / kRootCrate);
  writeNewFile(made.bag, folder / kBagFile);
  writeNewFile(made.bagInfo, folder / kBagInfoFile);
  writeNewFile(made.tagManifest, folder / kTagManifestFile);
  writeNewFile(libraryText(library), folder / kLibraryFile);
}

}  // namespace

PendingFolder pendingFolder(const fs::path& folder, PendingFolder::Existing existing) {
  auto pending = PendingFolder::beside(folder, existing);
  if (!pending) throw failed(formats::printable(pending.error().message));
  return *std::move(pending);
}

void commitFolder(PendingFolder& pending) {
  const auto done = pending.commit(PendingFolder::Flush::System);
  if (!done) throw failed(formats::printable(done.error().message));
}

void linkFile(const fs::path& from, const fs::path& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return;
  std::error_code error;
  fs::copy_file(from, to, error);
  if (error) throw failed(shownPath(from) + ": cannot be copied: " + error.message());
}

IncomingCase::IncomingCase(const fs::path& library)
    : m_workspace(pendingFolder(library, formats::PendingFolder::Existing::Replace)) {
  fs::create_directory(folder());
}

fs::path IncomingCase::newPath(const std::string& path) const {
  if (!isRecordedPath(path))
    throw PathError(quotedText(path) +
                    ": a library cannot have a file of this name; expected parts of " + kPathRule +
                    ", 255 bytes in all");
  for (const RecordedFile& file : record.files)
    if (lowerCase(file.path) == lowerCase(path))
      throw PathError(quotedText(path) + ": there are two files of this name");
  const fs::path place = folder() / path;
  fs::create_directories(place.parent_path());
  return place;
}

void IncomingCase::note(const std::string& path, const std::string& role,
                        const std::string& target) {
  const FileDigest digest = digestOfFile(folder() / path);
  record.files.push_back({path, role, target, mediaType(path), digest.bytes, digest.sha256});
}

void IncomingCase::add(const std::string& path, const std::string& role, std::string_view bytes,
                       const std::string& target) {
  const fs::path place = newPath(path);
  writeNewFile(bytes, place);
  note(path, role, target);
}

void IncomingCase::addFile(const std::string& path, const std::string& role,
                           const fs::path& source) {
  if (const std::error_code error = copyPlain(source, newPath(path)))
    throw failed(shownPath(source) + ": cannot be copied: " + error.message());
  note(path, role, "");
}

std::string mediaType(const std::string& path) {
  static const std::map<std::string, const char*> kTypes = {
      {"csv", "text/csv"},        {"glb", "model/gltf-binary"}, {"gltf", "model/gltf+json"},
      {"html", "text/html"},      {"jpg", "image/jpeg"},        {"json", "application/json"},
      {"md", "text/markdown"},    {"obj", "model/obj"},         {"pdf", "application/pdf"},
      {"png", "image/png"},       {"py", "text/x-python"},      {"stl", "model/stl"},
      {"svg", "image/svg+xml"},   {"txt", "text/plain"},        {"usda", "model/vnd.usda"},
      {"xml", "application/xml"}, {"zip", "application/zip"},   {"3mf", "model/3mf"}};
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] == '/') return "application/octet-stream";
  const auto found = kTypes.find(lowerCase(path.substr(dot + 1)));
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

LibraryChange::LibraryChange(const fs::path& library, Progress& progress)
    : m_folder(fs::weakly_canonical(library)),
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

  LibraryTexts texts(next);
  for (const LibraryEntry& entry : next.cases) {
    m_progress.check();
    const auto incoming = m_incoming.find(entry.id);
    const CaseRecord record =
        incoming != m_incoming.end() ? incoming->second.record : openRecord(m_folder, entry);
    const std::string crate = caseCrate(record);
    if (incoming == m_incoming.end())
      keepCase(m_folder / kPayload / entry.id, data / entry.id, crate);
    texts.add(entry, record, crate);
  }
  writeRevision(pending.path(), next, texts);
  makeFolderLike(m_folder, pending.path());  // may others look into it as they might before
  commitFolder(pending);
  m_library = std::move(next);
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

namespace {

/// A hidden folder with an empty data/ that becomes a new library; `library` gets revision 1 and
/// its generator. Throws as makeLibrary().
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

}  // namespace

void makeLibrary(const fs::path& folder, LibraryFile library) {
  library.cases.clear();
  PendingFolder pending = newLibraryFolder(folder, library);
  LibraryTexts texts(library);
  writeRevision(pending.path(), library, texts);
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
  LibraryTexts texts(library);
  for (const LibraryEntry& entry : library.cases) {
    const CaseRecord record = openRecord(from, entry);
    const fs::path folder = from / kPayload / entry.id;
    const fs::path target = pending.path() / kPayload / entry.id;
    fs::create_directory(target);
    for (const RecordedFile& file : record.files) {
      progress.check();
      copyRecorded(folder / file.path, target / file.path, file);
    }
    const std::string crate = caseCrate(record);
    writeNewFile(readWholeFile(folder / kRecordFile, "record"), target / kRecordFile);
    writeNewFile(crate, target / kCrateFile);
    texts.add(entry, record, crate);
  }
  writeRevision(pending.path(), library, texts);
  commitFolder(pending);
  return library;
}

}  // namespace lumen::convert
