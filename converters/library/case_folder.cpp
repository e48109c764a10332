// SPDX-License-Identifier: Apache-2.0
#include "converters/library/case_folder.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "converters/base/sha256.h"

namespace lumen::convert {

namespace {

// Times of files come from a clock that ticks every few milliseconds, and some file systems keep
// whole or even seconds.
constexpr std::time_t kSettled = 3;  // s

// Names that are kept to be reported in order: more than one would read, and a bound for a folder
// of millions.
constexpr std::size_t kMostNames = 100000;

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
    std::size_t more = 0;
    const PlainRead seen = library.list(joined(folder, below), [&](const PlainEntry& entry) {
      const std::string path = joined(below, entry.name);
      newest = std::max({newest, entry.status.st_ctim.tv_sec, entry.status.st_mtim.tv_sec});
      if (expected.files.contains(path) || expected.folders.contains(path)) {
        known.emplace(path, entry);
        return true;
      }
      others.emplace(path, entry);
      if (others.size() > kMostNames) {
        others.erase(std::prev(others.end()));
        ++more;
      }
      return true;
    });
    // a missing folder is reported by each file that is listed in it
    if (seen.fault == PlainFault::Unreadable)
      state.faults.add({FaultCode::FileUnreadable, caseId, joined(folder, below), seen.found,
                        "a folder that can be read"});
    for (const auto& [path, entry] : known) mark(marks, path, entry.status);
    for (const auto& [path, entry] : others)
      state.faults.add(unlisted(entry, joined(folder, path), caseId));
    if (more > 0)
      state.faults.add({FaultCode::FileUnlisted, caseId, joined(folder, below),
                        std::to_string(more) + " more that nothing lists", "nothing there"});
  }
  state.mark = sha256(std::as_bytes(std::span(marks)));
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
      if ((!isFolder && !isPlain(entry)) || (isFolder && depth >= kDeepest))
        others.emplace(entry.name, entry);
      else if (isFolder)
        below.insert(joined(path, entry.name));
      return others.size() < kMostNames;
    });
    for (const std::string& name : below) folders.emplace_back(name, depth + 1);
    if (seen.fault == PlainFault::Unreadable)
      faults.add({FaultCode::FileUnreadable, "", path, seen.found, "a folder that can be read"});
    for (const auto& [name, entry] : others)
      faults.add({FaultCode::FileKind, "", joined(path, name), kindText(entry.status.st_mode),
                  isPlain(entry) ? "no folders as deep as this" : "a file or a folder"});
  }
}

}  // namespace lumen::convert
