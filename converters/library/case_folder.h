// SPDX-License-Identifier: Apache-2.0
// Entries in the folder of a case, against the list of its record.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "converters/library/library_fault.h"
#include "converters/library/plain_folder.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
