// SPDX-License-Identifier: Apache-2.0
// Check of the bag and the RO-Crate of a library against library.json and the records. One case at
// a time is in memory.
#pragma once

#include <memory>
#include <string>

#include "converters/base/progress.h"
#include "converters/library/check_case.h"
#include "converters/library/library_fault.h"
#include "converters/library/library_file.h"
#include "converters/library/plain_folder.h"

namespace lumen::convert {

class BagCheck {
public:
  /// `library` has the cases sorted, each once; `text` is library.json. All must outlive this.
  BagCheck(const PlainFolder& folder, const LibraryFile& library, const std::string& text,
           const Progress& progress);
  ~BagCheck();
  BagCheck(const BagCheck&) = delete;
  BagCheck& operator=(const BagCheck&) = delete;

  /// Checks the next case. A record that is not there leaves the files that follow from it unknown.
  void add(const LibraryEntry& entry, const CaseCheck& check);
  /// Ends the check after the last case.
  void finish(FaultList& faults);

private:
  struct State;
  std::unique_ptr<State> m_state;
};

}  // namespace lumen::convert
