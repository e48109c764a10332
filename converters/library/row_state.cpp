// SPDX-License-Identifier: Apache-2.0
#include "converters/library/row_state.h"

#include "converters/library/build_row.h"
#include "converters/library/library_lock.h"

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

/// Whether the row may be made already, so that only its inputs' digests decide.
bool mayBeMade(const RowState& state, const LibraryFile& library) {
  if (state.kind == Kind::Made || state.kind == Kind::InLibrary) return true;
  const std::string& id = state.row->id;
  return id.empty() ? !library.cases.empty() : findCase(library, id) != nullptr;
}

void noteKept(const PlannedRow& plan, const LibraryFile& library, const BuildOptions& options) {
  RowNote note;
  note.state = RowNote::State::Kept;
  note.result.id = plan.id;
  note.recipe = plan.recipe.all;
  writeNote(options.work, noteName(*plan.row, options.version, library.licence), note);
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

RowsToMake findRowsToMake(const std::vector<BuildRow>& rows, const fs::path& library,
                          const BuildOptions& options, const Progress& progress) {
  const LibraryFile file = openLibrary(library);
  RowsToMake found;
  for (const BuildRow& row : rows) {
    progress.check();
    if (isResumedRow(row, file, options)) {
      ++found.kept;
      continue;
    }
    if (mayBeMade(stateOfRow(row, library, file, options), file)) {
      const PlannedRow plan = planRow(row, file, options, progress);
      if (isMadeFrom(library, file, plan.id, plan.recipe.all)) {
        noteKept(plan, file, options);
        ++found.kept;
        continue;
      }
      if (isStaged(plan.staged, plan.id)) {
        ++found.staged;
        continue;
      }
    }
    found.lines.push_back(row.line);
  }
  return found;
}

}  // namespace lumen::convert
