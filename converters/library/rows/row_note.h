// SPDX-License-Identifier: Apache-2.0
// Notes on rows, and the state of each row by notes and library alone, without reading an input.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/library/rows/build.h"

namespace lumen::convert {

// Notes in the folder for work on what became of each row, by which other processes know of it.

struct RowNote {
  RowResult result;    ///< without its line, which a change of the list moves
  std::string recipe;  ///< digest of all that the case is made from; empty before inputs are read
  std::string folder;  ///< the row's folder in the folder for work; empty as `recipe`
  std::string staged;  ///< the library of this case alone, in `folder`
  std::string place;   ///< machine, process and task that made it
};

/// Name of a row's note: a digest of the row without the content of its files, so that it costs no
/// reading. Equal rows share a note. `shared`: as makeRecipe() takes it.
std::string noteName(const BuildRow& row, const std::string& version, const std::string& shared);

/// Throws Error(Failed) if it cannot be written.
void writeNote(const std::filesystem::path& work, const std::string& name, const RowNote& note);

/// The note of that name; none where there is no such file, or one that is no note.
std::optional<RowNote> readNote(const std::filesystem::path& work, const std::string& name);

struct RowStatus {
  RowState state = RowState::Waiting;
  const BuildRow* row = nullptr;
  std::optional<RowNote> note;
};

/// States in the order of the list. A row without a note is in the library if its id is.
std::vector<RowStatus> rowStates(const std::vector<BuildRow>& rows,
                                 const std::filesystem::path& library, const BuildOptions& options);

}  // namespace lumen::convert
