// SPDX-License-Identifier: Apache-2.0
#include "converters/library/row_state.h"

#include "converters/library/build_row.h"
#include "converters/library/row_lock.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

using Kind = RowState::Kind;

/// A row that was made, or kept: its case is in one of two places, or gone.
Kind kindOfMade(const RowNote& note, const fs::path& folder, const LibraryFile& library,
                const fs::path& work) {
  if (!note.staged.empty() && isStaged(work / note.folder / note.staged, note.result.id))
    return Kind::Made;
  return isMadeFrom(folder, library, note.result.id, note.recipe) ? Kind::InLibrary : Kind::Waiting;
}

RowState stateOfRow(const BuildRow& row, const fs::path& folder, const LibraryFile& library,
                    const BuildOptions& options) {
  RowState state;
  state.row = &row;
  state.note = readNote(options.work, noteName(row, options.version, library.licence));
  if (!state.note) {
    const bool isThere = !row.id.empty() && findCase(library, row.id) != nullptr;
    state.kind = isThere ? Kind::InLibrary : Kind::Waiting;
  } else if (state.note->state == RowNote::State::Failed) {
    state.kind = Kind::Failed;
  } else if (state.note->state == RowNote::State::NeedsPerson) {
    state.kind = Kind::NeedsPerson;
  } else if (state.note->state == RowNote::State::Running) {
    const bool isHeld = RowLock::isHeld(options.work / state.note->folder);
    state.kind = isHeld ? Kind::Running : Kind::Interrupted;
  } else {
    state.kind = kindOfMade(*state.note, folder, library, options.work);
  }
  return state;
}

}  // namespace

const char* stateWord(Kind kind) {
  switch (kind) {
    case Kind::Waiting:
      return "waiting";
    case Kind::Running:
      return "running";
    case Kind::Interrupted:
      return "interrupted";
    case Kind::Made:
      return "made";
    case Kind::Failed:
      return "failed";
    case Kind::NeedsPerson:
      return "needs a person";
    case Kind::InLibrary:
      return "in the library";
  }
  return "";
}

std::vector<RowState> rowStates(const std::vector<BuildRow>& rows, const fs::path& library,
                                const BuildOptions& options) {
  const LibraryFile file = openLibrary(library);
  std::vector<RowState> states;
  states.reserve(rows.size());
  for (const BuildRow& row : rows) states.push_back(stateOfRow(row, library, file, options));
  return states;
}

}  // namespace lumen::convert
