// SPDX-License-Identifier: Apache-2.0
// All that is wrong with one case of a library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/check_journal.h"
#include "converters/library/library_fault.h"
#include "converters/library/library_file.h"
#include "converters/library/plain_folder.h"
#include "converters/library/record.h"

namespace lumen::convert {

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
