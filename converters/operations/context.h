// SPDX-License-Identifier: Apache-2.0
// What holds for a whole operation: its listener, and how messages word a field of its options.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "converters/base/field_word.h"
#include "converters/base/progress.h"

namespace lumen::operations {

/// The caller makes it once; operations pass it on as it is. Operations read no files, keep no state
/// and run on the threads of the caller's arena of oneTBB. No result depends on their number.
struct Context {
  /// Hears of stages, warnings and details; cancel() ends the operation with Error(Cancelled). One
  /// whose warn() throws makes a warning an error.
  Progress& progress;
  FieldWord fieldWord = {};  ///< how messages name a field of options
  /// Where a reader of warnings finds the remarks that are too many for them.
  std::string allRemarks = "the result";

  /// The same for work within the operation, with a listener of its own.
  [[nodiscard]] Context within(Progress& other) const { return {other, fieldWord, allRemarks}; }
  [[nodiscard]] std::string field(std::string_view name,
                                  std::optional<std::size_t> value = {}) const {
    return fieldWord(name, value);
  }
};

}  // namespace lumen::operations
