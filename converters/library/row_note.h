// SPDX-License-Identifier: Apache-2.0
// Notes in the folder for work on what became of each row, by which other processes know of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "converters/library/build.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
