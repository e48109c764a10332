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

namespace lumen::convert {

// Notes in the folder for work on what became of each row, by which other processes know of it.

struct RowNote {
  enum class State : std::uint8_t { Running, Made, Kept, Failed, NeedsPerson };
  State state = State::Running;
  RowResult result;    ///< without its line, which a change of the list moves
  std::string recipe;  ///< digest of all that the case is made from; empty before inputs are read
  std::string folder;  ///< the row's folder in the folder for work; empty as `recipe`
  std::string staged;  ///< the library of this case alone, in `folder`
  std::string place;   ///< machine, process and task that made it

  /// The state of a row that has ended.
  static State stateOf(RowEnd end);
};

/// Name of a row's note: a digest of the row without the content of its files, so that it costs no
/// reading. Equal rows share a note. `shared`: as makeRecipe() takes it.
std::string noteName(const BuildRow& row, const std::string& version, const std::string& shared);

/// Throws Error(Failed) if it cannot be written.
void writeNote(const std::filesystem::path& work, const std::string& name, const RowNote& note);

/// The note of that name; none where there is no such file, or one that is no note.
std::optional<RowNote> readNote(const std::filesystem::path& work, const std::string& name);

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
