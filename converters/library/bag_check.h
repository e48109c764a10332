// SPDX-License-Identifier: Apache-2.0
// The bag and the RO-Crate of a library beside what library.json and the records give. One case at
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

  /// The next case. Nothing is known of what follows from a record that is not there.
  void add(const LibraryEntry& entry, const CaseCheck& check);
  /// After the last case.
  void finish(FaultList& faults);

private:
  struct State;
  std::unique_ptr<State> m_state;
};

}  // namespace lumen::convert
