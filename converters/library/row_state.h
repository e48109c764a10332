// SPDX-License-Identifier: Apache-2.0
// State of each row of a list by notes and library alone, without reading an input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/library/build.h"
#include "converters/library/library_file.h"
#include "converters/library/row_note.h"

namespace lumen::convert {

struct RowState {
  enum class Kind : std::uint8_t {
    Waiting,      ///< nobody has begun it
    Running,      ///< a process makes it now
    Interrupted,  ///< the process that made it ended before the row did
    Made,         ///< its case lies in the folder for work
    Failed,
    NeedsPerson,  ///< its case waits in the folder for work for a person's look
    InLibrary
  };
  Kind kind = Kind::Waiting;
  const BuildRow* row = nullptr;
  std::optional<RowNote> note;
};

/// The word for a state: "waiting", "running", "interrupted", "made", "failed",
/// "needs a person", "in the library".
const char* stateWord(RowState::Kind kind);

/// States in the order of the list. A row without a note is in the library if its id is.
std::vector<RowState> rowStates(const std::vector<BuildRow>& rows,
                                const std::filesystem::path& library, const BuildOptions& options);

}  // namespace lumen::convert
