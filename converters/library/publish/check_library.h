// SPDX-License-Identifier: Apache-2.0
// Check of a library for every fault: spec/library.md, Faults. Cases are checked in parallel;
// answers come in one order on any number of threads, and records are in memory only while their
// case is checked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/index/library_file.h"
#include "converters/library/publish/library_fault.h"
#include "converters/library/publish/plain_folder.h"

namespace lumen::convert {

struct LibraryCheckOptions {
  std::size_t mostFaults = 1000;  ///< maximum number kept; all are counted
  std::filesystem::path journal;  ///< CheckJournal's file; none: all is read
};

struct LibraryCheck {
  FaultList faults;
  std::optional<LibraryFile> library;  ///< none if library.json cannot be read
  std::size_t cases = 0;               ///< number of cases checked
  std::size_t passedOver = 0;          ///< number of these that the journal knew
  std::uint64_t files = 0, bytes = 0;  ///< number and size of the cases' files read
};

/// library.json, or a fault with the reason why there is none.
std::optional<std::string> readLibraryText(const PlainFolder& folder, FaultList& faults,
                                           const Progress& progress);

/// Finds every fault of the library with that library.json. Throws Error(Cancelled), and as
/// CheckJournal.
LibraryCheck checkLibrary(const PlainFolder& folder, const std::string& text,
                          const LibraryCheckOptions& options, Progress& progress);

}  // namespace lumen::convert
