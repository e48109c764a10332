// SPDX-License-Identifier: Apache-2.0
#include "converters/library/change.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/library/derived.h"
#include "converters/library/spdx.h"
#include "formats/case/atomic_file.h"
#include "formats/case/case_file.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using formats::PendingFolder;

const std::string kGenerator = "lumen " LUMEN_VERSION;

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

void writeFile(std::string_view text, const fs::path& file) {
  std::ofstream out(file, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) throw failed(shownPath(file) + ": cannot write this file");
}

std::string readText(const fs::path& file) {
  const auto bytes = formats::readFileBytes(file);
  if (!bytes) return {};
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

/// What a change writes anew, or what would no longer be true of the library after it.
bool isOfOldRevision(const std::string& name) {
  constexpr std::array<std::string_view, 9> kNames = {
      kLibraryFile,  "library.json.minisig", "library.json.sig", kBagFile, kBagInfoFile,
      kManifestFile, kTagManifestFile,       "index.html",       "site"};
  return name == kPayload || std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

/// The same bytes under a second name, where the file system has such; otherwise a copy.
void link(const fs::path& from, const fs::path& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return;
  std::error_code error;
  fs::copy_file(from, to, error);
  if (error) throw failed(shownPath(from) + ": cannot be copied: " + error.message());
}

void makeFolderLike(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directory(to, error);
  fs::permissions(to, fs::status(from).permissions() | fs::perms::owner_all, error);
}

/// Everything below `from` below `to`, which is there. What nothing lists comes along: it is somebody's.
void linkAll(const fs::path& from, const fs::path& to,
             const std::function<bool(const std::string& name)>& skips = {}) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(from, error)) {
    const fs::path target = to / entry.path().filename();
    if (skips && skips(entry.path().filename().string())) continue;
    const fs::file_status status = entry.symlink_status();
    if (fs::is_directory(status)) {
      makeFolderLike(entry.path(), target);
      linkAll(entry.path(), target);
    } else if (fs::is_regular_file(status)) {
      link(entry.path(), target);
    } else if (fs::is_symlink(status)) {
      fs::copy_symlink(entry.path(), target);
    } else {
      throw invalidInput(shownPath(entry.path()) + ": found a device or a pipe, expected files");
    }
  }
  if (error) throw failed(shownPath(from) + ": cannot be read: " + error.message());
}

/// A file that is written piece by piece.
class GrowingFile {
public:
  explicit GrowingFile(fs::path file) : m_file(std::move(file)), m_out(m_file, std::ios::binary) {}
  TextSink sink() {
    return [this](std::string_view text) {
      m_out.write(text.data(), static_cast<std::streamsize>(text.size()));
    };
  }
  void close() {
    m_out.close();
    if (!m_out) throw failed(shownPath(m_file) + ": cannot write this file");
  }

private:
  fs::path m_file;
  std::ofstream m_out;
};

/// A case of the old revision that stays as it is.
void keepCase(const fs::path& from, const fs::path& to, const std::string& crate) {
  makeFolderLike(from, to);
  // the crate of a case follows from its record, but other versions of lumen may say it in other words
  const bool isSame = readText(from / kCrateFile) == crate;
  linkAll(from, to, [isSame](const std::string& name) { return !isSame && name == kCrateFile; });
  if (!isSame) writeFile(crate, to / kCrateFile);
}

/// The files of `folder` but for its cases; the files of library.json and all that follows from it and the records.
class RevisionWriter {
public:
  RevisionWriter(const fs::path& folder, const LibraryFile& library)
      : m_folder(folder),
        m_library(library),
        m_manifest(folder / kManifestFile),
        m_crate(folder / kPayload / kCrateFile),
        m_texts(library, m_manifest.sink(), m_crate.sink()) {}
  void add(const CaseRecord& record, const std::string& crate) { m_texts.add(record, crate); }
  void finish() {
    const TagTexts tags = m_texts.finish();
    m_manifest.close();
    m_crate.close();
    writeFile(tags.bag, m_folder / kBagFile);
    writeFile(tags.bagInfo, m_folder / kBagInfoFile);
    writeFile(tags.tagManifest, m_folder / kTagManifestFile);
    writeFile(libraryText(m_library), m_folder / kLibraryFile);
  }

private:
  fs::path m_folder;
  const LibraryFile& m_library;
  GrowingFile m_manifest, m_crate;
  LibraryTexts m_texts;
};

PendingFolder pendingBeside(const fs::path& folder, PendingFolder::Existing existing) {
  auto pending = PendingFolder::beside(folder, existing);
  if (!pending) throw failed(formats::printable(pending.error().message));
  return *std::move(pending);
}

void putInPlace(PendingFolder& pending) {
  const auto done = pending.commit(PendingFolder::Flush::System);
  if (!done) throw failed(formats::printable(done.error().message));
}

bool isSamePlace(int descriptor, const fs::path& path) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

/// False once nobody else has it; a file system without locks has no other writers either.
bool isLockedByOthers(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && (errno == EWOULDBLOCK || errno == EINTR);
}

}  // namespace

LibraryLock::LibraryLock(const fs::path& library, Progress& progress) {
  bool waits = false;
  for (;; ::close(m_descriptor)) {
    m_descriptor = ::open(library.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (m_descriptor < 0)
      throw invalidInput(shownPath(library) + ": cannot be opened as a folder: " +
                         std::generic_category().message(errno));
    while (isLockedByOthers(m_descriptor)) {
      if (!std::exchange(waits, true))
        progress.detail(shownPath(library) + ": waiting for another change of this library");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (progress.cancelled()) ::close(std::exchange(m_descriptor, -1));
      progress.check();
    }
    // another writer may have exchanged the folder while this one waited
    if (isSamePlace(m_descriptor, library)) return;
  }
}

LibraryLock::~LibraryLock() {
  if (m_descriptor >= 0) ::close(m_descriptor);
}

LibraryChange::LibraryChange(const fs::path& library, Progress& progress)
    : m_folder(existingFolder(library)),
      m_progress(progress),
      m_lock(m_folder, progress),
      m_library(openLibrary(m_folder)) {
  for (std::size_t i = 1; i < m_library.cases.size(); ++i)
    if (m_library.cases[i - 1].id >= m_library.cases[i].id)
      throw invalidInput(shownPath(m_folder / kLibraryFile) + ": the ids of its cases are not " +
                         "sorted, or one is there twice; lumen library check tells more");
}

void LibraryChange::put(CaseRecord record, fs::path files) {
  const std::string id = record.id;
  if (const std::string fault = missingStatement(record.about); !fault.empty())
    throw invalidInput("case " + id + ": " + fault);
  if (!m_incoming.emplace(id, Incoming{std::move(record), std::move(files)}).second)
    throw invalidInput("two cases of one change have the id " + id);
}

void LibraryChange::remove(const std::string& id) {
  if (findCase(m_library, id) == nullptr)
    throw Error(ErrorKind::Usage, "the library has no case " + formats::printable(id) +
                                      "; lumen library list tells what it has");
  m_removed.insert(id);
}

LibraryEntry LibraryChange::bringIn(Incoming& incoming, const fs::path& data,
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
    link(incoming.files / file.path, folder / file.path);
    entry.bytes += file.bytes;
  }
  writeFile(text, folder / kRecordFile);
  writeFile(caseCrate(record), folder / kCrateFile);
  return entry;
}

void LibraryChange::commit(const std::string& date) {
  LibraryFile next = m_library;
  next.revision += 1;
  next.previous = sha256(readText(m_folder / kLibraryFile));
  next.date = date;
  next.generator = kGenerator;
  std::erase_if(next.cases, [this](const LibraryEntry& entry) {
    return m_removed.contains(entry.id) || m_incoming.contains(entry.id);
  });

  PendingFolder pending = pendingBeside(m_folder, PendingFolder::Existing::Replace);
  const fs::path data = pending.path() / kPayload;
  linkAll(m_folder, pending.path(), isOfOldRevision);
  makeFolderLike(m_folder / kPayload, data);
  linkAll(m_folder / kPayload, data, [&](const std::string& name) {
    return name == kCrateFile || findCase(m_library, name) != nullptr;
  });
  for (auto& [id, incoming] : m_incoming) next.cases.push_back(bringIn(incoming, data, date));
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
  putInPlace(pending);
  m_library = std::move(next);
  m_incoming.clear();
  m_removed.clear();
}

void requireNewId(const LibraryFile& library, const std::string& id) {
  if (findCase(library, id) != nullptr)
    throw Error(ErrorKind::Usage, "the library has a case " + id +
                                      " already; --replace puts a better version in its place, " +
                                      "--id gives another name");
}

void makeLibrary(const fs::path& folder, LibraryFile library) {
  if (const std::string fault = licenceFault(library.licence); !fault.empty())
    throw invalidInput(fault);
  library.revision = 1;
  library.previous.reset();
  library.generator = kGenerator;
  library.cases.clear();
  readLibrary(libraryText(library), kLibraryFile);  // nothing is written that could not be read
  std::error_code error;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    throw failed(shownPath(folder) + ": there is something already; expected a folder that does " +
                 "not exist, or is empty");
  PendingFolder pending = pendingBeside(folder, PendingFolder::Existing::Refuse);
  fs::create_directory(pending.path() / kPayload);
  RevisionWriter writer(pending.path(), library);
  writer.finish();
  putInPlace(pending);
}

CaseRecord openRecord(const fs::path& library, const LibraryEntry& entry) {
  const fs::path file = library / kPayload / entry.id / kRecordFile;
  std::error_code error;
  const std::string text =
      fs::is_regular_file(fs::symlink_status(file, error)) ? readText(file) : std::string();
  if (text.size() != entry.recordBytes || sha256(text) != entry.recordSha256)
    throw invalidInput(shownPath(file) + ": is missing, or is not what " + kLibraryFile +
                       " states; lumen library check tells more");
  CaseRecord record = readRecord(text, file);
  if (record.id != entry.id)
    throw invalidInput(shownPath(file) + ": found the id " + record.id + ", expected " + entry.id);
  return record;
}

}  // namespace lumen::convert
