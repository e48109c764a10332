// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/check_library.h"

#include <algorithm>
#include <map>
#include <memory>
#include <unordered_set>
#include <utility>
#include <vector>

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/index/derived.h"
#include "converters/library/publish/bag_check.h"
#include "converters/library/publish/check_case.h"
#include "converters/library/publish/check_journal.h"
#include "converters/library/publish/record_faults.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

namespace {

/// Bytes: 100,000 cases with long titles.
constexpr std::uint64_t kMostLibrary = std::uint64_t{1} << 27;

/// Cases in progress for each thread: so that one large case does not stop the others, and memory
/// stays bounded.
constexpr std::size_t kAhead = 8;

/// Sorts the cases and leaves each id once; reports a fault where that was not so.
void sortCases(LibraryFile& library, FaultList& faults) {
  std::unordered_set<std::string> seen;
  std::vector<LibraryEntry> kept;
  std::string last;
  bool isReported = false;
  for (LibraryEntry& entry : library.cases) {
    if (!seen.insert(entry.id).second) {
      faults.add({FaultCode::LibraryIdTwice, entry.id, kLibraryFile,
                  "the id " + quotedText(entry.id) + " again", "each id once"});
      continue;
    }
    if (entry.id < last && !isReported) {
      faults.add({FaultCode::LibraryOrder, entry.id, kLibraryFile,
                  quotedText(entry.id) + " after " + quotedText(last), "cases sorted by id"});
      isReported = true;
    }
    last = entry.id;
    kept.push_back(std::move(entry));
  }
  std::sort(kept.begin(), kept.end(),
            [](const LibraryEntry& a, const LibraryEntry& b) { return a.id < b.id; });
  library.cases = std::move(kept);
}

/// The library's folder and data/, in which nothing else may be; and the kinds of files that
/// nothing reads here: pages, signatures, remains of a writer.
void checkFolders(const PlainFolder& folder, const LibraryFile& library, FaultList& faults) {
  ExpectedFiles root, payload;
  root.files = {kLibraryFile, kBagFile, kBagInfoFile, kManifestFile, kTagManifestFile, kPayload};
  std::map<std::string, mode_t> entries;
  const PlainRead read = folder.list(
      "", [&](const PlainEntry& entry) { entries.emplace(entry.name, entry.status.st_mode); });
  for (const auto& [name, mode] : entries) {
    const bool isFile = S_ISREG(mode), isFolder = S_ISDIR(mode);
    if (isOfOneRevision(name) || formats::isTemporary(folder.path() / name))
      root.files.insert(name);
    if (isOfOneRevision(name) && !(name == kSiteFolder ? isFolder : isFile))
      faults.add({FaultCode::FileKind, "", name, kindText(mode),
                  name == kSiteFolder ? "a folder" : "a file"});
  }
  if (read.fault != PlainFault::None)
    faults.add({FaultCode::FileUnreadable, "", ".", read.found, "a folder that can be read"});
  faults.append(walkFolder(folder, "", root, "", faults.maximum()).faults);
  payload.files.insert(kCrateFile);
  for (const LibraryEntry& entry : library.cases) payload.files.insert(entry.id);
  faults.append(walkFolder(folder, kPayload, payload, "", faults.maximum()).faults);
  checkKinds(folder, kSiteFolder, faults);
}

/// Result of a case, in its place.
struct Checked {
  std::size_t at = 0;
  std::shared_ptr<CaseCheck> check;  // TBB copies values between filters
};

/// All cases, in parallel, and the checks that follow from them, in order.
void checkCases(const PlainFolder& folder, const LibraryFile& library, CheckJournal& journal,
                BagCheck& bag, LibraryCheck& result, Progress& progress) {
  std::size_t next = 0;
  const auto begin = [&](tbb::flow_control& control) {
    if (next == library.cases.size() || progress.cancelled()) {
      control.stop();
      return std::size_t{0};
    }
    return next++;
  };
  const auto check = [&](std::size_t at) {
    return Checked{at, std::make_shared<CaseCheck>(checkCase(folder, library.cases[at], journal,
                                                             result.faults.maximum(), progress))};
  };
  const auto collect = [&](const Checked& checked) {
    const LibraryEntry& entry = library.cases[checked.at];
    CaseCheck& of = *checked.check;
    bag.add(entry, of);
    if (!of.mark.empty()) journal.add(entry.id, of.mark);
    ++result.cases;
    result.passedOver += of.isPassedOver ? 1 : 0;
    result.files += of.files;
    result.bytes += of.bytes;
    result.faults.append(std::move(of.faults));
    progress.advance();
  };
  const auto tokens = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) * kAhead;
  tbb::parallel_pipeline(
      tokens, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin) &
                  tbb::make_filter<std::size_t, Checked>(tbb::filter_mode::parallel, check) &
                  tbb::make_filter<Checked, void>(tbb::filter_mode::serial_in_order, collect));
  progress.check();
}

}  // namespace

std::optional<std::string> readLibraryText(const PlainFolder& folder, FaultList& faults,
                                           const Progress& progress) {
  PlainRead text = folder.read(kLibraryFile, {{}, true, kMostLibrary}, progress);
  if (text.isRead) return std::move(text.content);
  const bool isTooLong = text.fault == PlainFault::None;
  faults.add({FaultCode::LibraryFile, "", kLibraryFile,
              isTooLong ? counted(text.bytes, "byte", "bytes") : text.found,
              isTooLong ? "at most 128 MiB" : "a file"});
  return {};
}

LibraryCheck checkLibrary(const PlainFolder& folder, const std::string& text,
                          const LibraryCheckOptions& options, Progress& progress) {
  LibraryCheck result{FaultList(options.mostFaults), {}, 0, 0, 0, 0};
  try {
    result.library = readLibrary(text, kLibraryFile);
  } catch (const Error& error) {
    std::string what = error.what();
    const std::string name = std::string(kLibraryFile) + ": ";
    if (what.starts_with(name)) what.erase(0, name.size());
    result.faults.add({FaultCode::LibraryFile, "", kLibraryFile, what, ""});
    return result;
  }
  LibraryFile& library = *result.library;
  sortCases(library, result.faults);
  checkLicence(library.licence, "", kLibraryFile, result.faults);
  checkPrivacy(library.title, "/title", "", kLibraryFile, result.faults);
  checkPrivacy(library.description, "/description", "", kLibraryFile, result.faults);
  checkFolders(folder, library, result.faults);
  CheckJournal none;
  std::optional<CheckJournal> journal;
  if (!options.journal.empty()) journal.emplace(options.journal, library.id);
  BagCheck bag(folder, library, text, progress);
  progress.begin("check", library.cases.size());
  checkCases(folder, library, journal ? *journal : none, bag, result, progress);
  bag.finish(result.faults);
  progress.end();
  return result;
}

}  // namespace lumen::convert
