// SPDX-License-Identifier: Apache-2.0
// All that is wrong with one case of a library.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/record.h"
#include "converters/library/publish/check_journal.h"
#include "converters/library/publish/library_fault.h"
#include "converters/library/publish/plain_folder.h"

namespace lumen::convert {

// Entries in the folder of a case, against the list of its record.

/// Files and folders that may be in a folder of a library.
struct ExpectedFiles {
  std::set<std::string> files, folders;  ///< relative to the folder

  /// A file, and the folders that it lies in.
  void add(const std::string& path);
};

/// State of a folder that a walk found.
struct FolderState {
  FaultList faults;
  std::string mark;        ///< digest of names, devices, inodes, sizes and times
  bool isSettled = false;  ///< the last change is so long ago that another would get another time
};

/// Walks through `folder` (relative to the library) and reports every entry that is not expected,
/// in the order of names. Folders that are not expected are not looked into.
FolderState walkFolder(const PlainFolder& library, const std::string& folder,
                       const ExpectedFiles& expected, const std::string& caseId, std::size_t most);

/// Reports entries that are neither file nor folder below `folder`, whose files nothing lists.
void checkKinds(const PlainFolder& library, const std::string& folder, FaultList& faults);

struct CaseCheck {
  FaultList faults;
  /// The record that the library states, and the case's RO-Crate that follows from it; none if the
  /// record is another.
  std::optional<CaseRecord> record;
  std::string crate;
  bool isPassedOver = false;  ///< the journal knows it
  std::string mark;  ///< for the journal: the case is whole, and nothing can have touched it unseen
  std::uint64_t files = 0, bytes = 0;  ///< number and size of the files read
};

/// Checks the case of `entry`; keeps `most` faults. Throws Error(Cancelled).
CaseCheck checkCase(const PlainFolder& library, const LibraryEntry& entry,
                    const CheckJournal& journal, std::size_t most, const Progress& progress);

}  // namespace lumen::convert
