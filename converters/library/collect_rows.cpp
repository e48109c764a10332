// SPDX-License-Identifier: Apache-2.0
#include "converters/library/collect_rows.h"

#include <map>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/library/build_row.h"
#include "converters/library/change.h"
#include "converters/library/row_state.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

using Kind = RowState::Kind;

std::string whyNotMade(const RowState& state) {
  switch (state.kind) {
    case Kind::Running:
      return "is being made still, by " + state.note->place;
    case Kind::Interrupted:
      return "its process ended before the case was made: " + state.note->place;
    case Kind::Failed:
      return state.note->result.why;
    default:
      return state.note ? "was made, but its case is gone" : "no process has begun it";
  }
}

/// One pass over the rows.
class Collection {
public:
  Collection(const std::vector<BuildRow>& rows, const fs::path& library,
             const BuildOptions& options, Progress& progress)
      : m_rows(rows), m_folder(library), m_options(options), m_progress(progress) {}

  std::vector<RowResult> run() {
    const LibraryFile library = openLibrary(m_folder);
    const std::vector<RowState> states = rowStates(m_rows, m_folder, m_options);
    std::vector<RowResult> results;
    for (const RowState& state : states) {
      m_progress.check();
      results.push_back(resultOf(state, library));
      const RowEnd end = results.back().end;
      if (end == RowEnd::Failed || end == RowEnd::NeedsPerson)
        warnOfRow(m_progress, results.back());
    }
    if (!m_staged.empty()) put();
    return results;
  }

private:
  RowResult resultOf(const RowState& state, const LibraryFile& library) {
    RowResult result = state.note ? state.note->result : RowResult{};
    result.line = state.row->line;
    if (result.id.empty()) result.id = state.row->id;
    if (isResumedRow(*state.row, library, m_options) && state.kind != Kind::Made) {
      result.end = RowEnd::Kept;
      return result;
    }
    if (state.kind == Kind::NeedsPerson) return result;
    const bool isThere = state.note && (state.kind == Kind::Made || state.kind == Kind::InLibrary);
    if (!isThere) return failure(std::move(result), whyNotMade(state), ErrorKind::Failed);
    const auto [first, isNew] = m_ids.emplace(result.id, result.line);
    if (!isNew)
      return failure(std::move(result), inputIsThatOf(first->second), ErrorKind::InvalidInput);
    result.end = state.kind == Kind::Made ? RowEnd::Made : RowEnd::Kept;
    if (state.kind == Kind::Made)
      m_staged.emplace(result.id, Staged{m_options.work / state.note->folder, state.note->staged});
    return result;
  }

  static RowResult failure(RowResult result, const std::string& why, ErrorKind kind) {
    result.end = RowEnd::Failed;
    result.why = why;
    if (result.code == 0) result.code = static_cast<int>(kind);
    return result;
  }

  void put() {
    LibraryChange change(m_folder, m_progress);
    for (const auto& [id, staged] : m_staged) {
      const fs::path library = staged.folder / staged.name;
      change.addOrReplace(recordIn(library, id), library / kPayload / id);
    }
    change.commit(m_options.day);
    std::error_code ignored;
    for (const auto& [id, staged] : m_staged) fs::remove_all(staged.folder, ignored);
  }

  struct Staged {
    fs::path folder;
    std::string name;
  };
  const std::vector<BuildRow>& m_rows;
  fs::path m_folder;
  const BuildOptions& m_options;
  Progress& m_progress;
  std::map<std::string, std::size_t> m_ids;  ///< and the lines that have them
  std::map<std::string, Staged> m_staged;
};

}  // namespace

std::vector<RowResult> collectRows(const std::vector<BuildRow>& rows, const fs::path& library,
                                   const BuildOptions& options, Progress& progress) {
  return Collection(rows, library, options, progress).run();
}

}  // namespace lumen::convert
