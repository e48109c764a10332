// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/check_case.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <map>
#include <span>
#include <utility>

#include "converters/base/privacy.h"
#include "converters/base/sha256.h"
#include "converters/base/text.h"
#include "converters/library/index/derived.h"
#include "converters/library/publish/record_faults.h"
#include "formats/case/case_file.h"

namespace lumen::convert {

namespace {

// Times of files come from a clock that ticks every few milliseconds, and some file systems keep
// whole or even seconds.
constexpr std::time_t kSettled = 3;  // s

// Pages lie in few folders; beyond this something else is there.
constexpr std::size_t kDeepest = 32;

/// Entries of a folder by name.
using Entries = std::map<std::string, PlainEntry>;

std::string joined(const std::string& folder, const std::string& name) {
  return folder.empty() ? name : folder + "/" + name;
}

bool isPlain(const PlainEntry& entry) {
  return S_ISREG(entry.status.st_mode) || S_ISDIR(entry.status.st_mode);
}

void mark(std::string& text, const std::string& path, const struct stat& s) {
  text += path;
  for (const long long number :
       {static_cast<long long>(s.st_mode & S_IFMT), static_cast<long long>(s.st_dev),
        static_cast<long long>(s.st_ino), static_cast<long long>(s.st_size),
        static_cast<long long>(s.st_mtim.tv_sec), static_cast<long long>(s.st_mtim.tv_nsec),
        static_cast<long long>(s.st_ctim.tv_sec), static_cast<long long>(s.st_ctim.tv_nsec)})
    text += " " + std::to_string(number);
  text += "\n";
}

LibraryFault unlisted(const PlainEntry& entry, const std::string& path, const std::string& caseId) {
  const std::string kind = kindText(entry.status.st_mode);
  if (!isPlain(entry)) return {FaultCode::FileKind, caseId, path, kind, "nothing there"};
  return {FaultCode::FileUnlisted, caseId, path, kind + " that nothing lists", "nothing there"};
}

}  // namespace

void ExpectedFiles::add(const std::string& path) {
  files.insert(path);
  for (std::size_t slash = path.find('/'); slash != std::string::npos;
       slash = path.find('/', slash + 1))
    folders.insert(path.substr(0, slash));
}

FolderState walkFolder(const PlainFolder& library, const std::string& folder,
                       const ExpectedFiles& expected, const std::string& caseId, std::size_t most) {
  FolderState state{FaultList(most), "", false};
  std::string marks;
  std::time_t newest = 0;
  std::vector<std::string> folders{""};
  folders.insert(folders.end(), expected.folders.begin(), expected.folders.end());
  for (const std::string& below : folders) {
    Entries known, others;
    const PlainRead seen = library.list(joined(folder, below), [&](const PlainEntry& entry) {
      const std::string path = joined(below, entry.name);
      newest = std::max({newest, entry.status.st_ctim.tv_sec, entry.status.st_mtim.tv_sec});
      const bool isKnown = expected.files.contains(path) || expected.folders.contains(path);
      (isKnown ? known : others).emplace(path, entry);
    });
    // a missing folder is reported by each file that is listed in it
    if (seen.fault == PlainFault::Unreadable)
      state.faults.add({FaultCode::FileUnreadable, caseId, joined(folder, below), seen.found,
                        "a folder that can be read"});
    for (const auto& [path, entry] : known) mark(marks, path, entry.status);
    for (const auto& [path, entry] : others)
      state.faults.add(unlisted(entry, joined(folder, path), caseId));
  }
  state.mark = sha256(marks);
  state.isSettled = newest + kSettled < std::time(nullptr);
  return state;
}

void checkKinds(const PlainFolder& library, const std::string& folder, FaultList& faults) {
  std::vector<std::pair<std::string, std::size_t>> folders{{folder, 0}};
  while (!folders.empty()) {
    const std::string path = folders.back().first;
    const std::size_t depth = folders.back().second;
    folders.pop_back();
    Entries others;
    std::set<std::string, std::greater<>> below;  // the first name is looked into first
    const PlainRead seen = library.list(path, [&](const PlainEntry& entry) {
      const bool isFolder = S_ISDIR(entry.status.st_mode);
      if (isFolder ? depth >= kDeepest : !isPlain(entry))
        others.emplace(entry.name, entry);
      else if (isFolder)
        below.insert(joined(path, entry.name));
    });
    for (const std::string& name : below) folders.emplace_back(name, depth + 1);
    if (seen.fault == PlainFault::Unreadable)
      faults.add({FaultCode::FileUnreadable, "", path, seen.found, "a folder that can be read"});
    for (const auto& [name, entry] : others)
      faults.add({FaultCode::FileKind, "", joined(path, name), kindText(entry.status.st_mode),
                  isPlain(entry) ? "no folders as deep as this" : "a file or a folder"});
  }
}

namespace {

constexpr std::uint64_t kMostRecord = 16U << 20U;  // bytes: tens of thousands of files
constexpr std::size_t kMostIssues = 20;            // issues of a case: the rest is lumen validate's

/// Check of one case.
class CaseChecker {
public:
  CaseChecker(const PlainFolder& library, const LibraryEntry& entry, const CheckJournal& journal,
              std::size_t most, const Progress& progress)
      : m_library(library),
        m_entry(entry),
        m_journal(journal),
        m_progress(progress),
        m_folder(std::string(kPayload) + "/" + entry.id),
        m_result{FaultList(most), {}, {}, false, {}, 0, 0} {}

  CaseCheck run() {
    auto record = readStated();
    if (!record) return std::move(m_result);
    ExpectedFiles expected;
    expected.add(kRecordFile);
    expected.add(kCrateFile);
    for (const RecordedFile& file : record->files) expected.add(file.path);
    FolderState before = walk(expected);
    if (m_isStated) m_result.crate = caseCrate(*record);
    const std::string mark = markOf(before);
    m_result.isPassedOver = m_result.faults.empty() && before.faults.empty() && m_isStated &&
                            m_journal.isUsed() && m_journal.knows(m_entry.id, mark);
    if (!m_result.isPassedOver) {
      checkRecord(*record, m_entry, recordPath(), m_result.faults);
      for (const RecordedFile& file : record->files) checkFile(file, *record);
      if (m_isStated) checkCrate();
      m_result.faults.append(std::move(before.faults));
      settle(expected, mark);
    }
    if (m_isStated) m_result.record = std::move(record);
    return std::move(m_result);
  }

private:
  [[nodiscard]] std::string pathOf(const std::string& name) const { return m_folder + "/" + name; }
  [[nodiscard]] std::string recordPath() const { return pathOf(kRecordFile); }
  [[nodiscard]] FolderState walk(const ExpectedFiles& expected) const {
    return walkFolder(m_library, m_folder, expected, m_entry.id, m_result.faults.maximum());
  }
  [[nodiscard]] std::string markOf(const FolderState& state) const {
    return sha256(m_entry.recordSha256 + state.mark);
  }
  void fault(FaultCode code, const std::string& path, std::string found, std::string expected) {
    m_result.faults.add({code, m_entry.id, path, std::move(found), std::move(expected)});
  }

  PlainRead read(const std::string& path, const WantedRead& wanted) {
    PlainRead result = m_library.read(path, wanted, m_progress);
    if (result.isRead) {
      ++m_result.files;
      m_result.bytes += result.bytes;
    }
    return result;
  }

  /// Adds the fault of a file that is missing or cannot be read; false if there is none.
  bool isNotHad(const PlainRead& read, const std::string& path) {
    if (read.fault == PlainFault::None) return false;
    const FaultCode code = read.fault == PlainFault::Missing ? FaultCode::FileMissing
                           : read.fault == PlainFault::Kind  ? FaultCode::FileKind
                                                             : FaultCode::FileUnreadable;
    fault(code, path, read.found, "a file");
    return true;
  }

  /// The record, even if it is another than the library states: it still lists the files there
  /// should be.
  std::optional<CaseRecord> readStated() {
    const std::string path = recordPath();
    const PlainRead text = read(path, {{}, true, kMostRecord});
    if (isNotHad(text, path)) return {};
    const bool isAsLong = text.bytes == m_entry.recordBytes;
    m_isStated = text.isRead && isAsLong && text.sha256 == m_entry.recordSha256;
    if (!isAsLong)
      fault(FaultCode::RecordDigest, path, counted(text.bytes, "byte", "bytes"),
            std::to_string(m_entry.recordBytes) + ", as in library.json");
    else if (text.isRead && !m_isStated)
      fault(FaultCode::RecordDigest, path, "SHA-256 " + text.sha256,
            m_entry.recordSha256 + ", as in library.json");
    if (!text.isRead) {
      fault(FaultCode::RecordFile, path, counted(text.bytes, "byte", "bytes"), "at most 16 MiB");
      return {};
    }
    return readRecordFaults(text.content, m_entry.id, path, m_result.faults);
  }

  void checkFile(const RecordedFile& file, const CaseRecord& record) {
    const std::string path = pathOf(file.path);
    const bool isCase = file.role == "case";
    const PlainRead content = read(path, {file.bytes, isCase});
    if (isNotHad(content, path)) return;
    if (!content.isRead)
      return fault(FaultCode::FileAltered, path, counted(content.bytes, "byte", "bytes"),
                   std::to_string(file.bytes));
    if (content.sha256 != file.sha256)
      return fault(FaultCode::FileAltered, path, "SHA-256 " + content.sha256, file.sha256);
    if (isCase) checkCaseFile(path, content.content, record);
  }

  void checkCaseFile(const std::string& path, const std::string& content,
                     const CaseRecord& record) {
    const auto bytes = std::as_bytes(std::span(content));
    const formats::ValidationReport report = formats::validateBytes(bytes, kMostIssues);
    for (const formats::Issue& issue : report.issues)
      if (formats::severityOf(issue.code) == formats::Severity::Error)
        fault(FaultCode::CaseInvalid, path, issue.text(), "");
    if (!report.valid()) return;
    if (const auto value = formats::decodeCase(bytes))
      checkFigures(*value, record, recordPath(), m_result.faults);
    for (const PrivacyFinding& finding : scanPrivacy(bytes))
      fault(FaultCode::Privacy, path, "at \"" + finding.pointer + "\": " + finding.message, "");
  }

  void checkCrate() {
    const std::string path = pathOf(kCrateFile);
    const std::string& expected = m_result.crate;
    const PlainRead content = read(path, {expected.size(), false});
    if (isNotHad(content, path)) return;
    if (!content.isRead)
      fault(FaultCode::Crate, path, counted(content.bytes, "byte", "bytes"),
            std::to_string(expected.size()) + ", which the record gives");
    else if (content.sha256 != sha256(expected))
      fault(FaultCode::Crate, path, "SHA-256 " + content.sha256,
            sha256(expected) + ", which the record gives");
  }

  /// Whether the journal may keep the case: the files that were walked through are there now, as
  /// they were, and have been for so long that a change in the meantime would show.
  void settle(const ExpectedFiles& expected, const std::string& mark) {
    if (!m_journal.isUsed() || !m_result.faults.empty() || !m_isStated) return;
    const FolderState after = walk(expected);
    if (after.isSettled && markOf(after) == mark) m_result.mark = mark;
  }

  const PlainFolder& m_library;
  const LibraryEntry& m_entry;
  const CheckJournal& m_journal;
  const Progress& m_progress;
  const std::string m_folder;
  bool m_isStated = false;
  CaseCheck m_result;
};

}  // namespace

CaseCheck checkCase(const PlainFolder& library, const LibraryEntry& entry,
                    const CheckJournal& journal, std::size_t most, const Progress& progress) {
  return CaseChecker(library, entry, journal, most, progress).run();
}

}  // namespace lumen::convert
