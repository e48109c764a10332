// SPDX-License-Identifier: Apache-2.0
#include "converters/library/rows/build.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/edit_steps.h"
#include "converters/library/index/change.h"
#include "converters/library/index/library_file.h"
#include "converters/library/index/library_lock.h"
#include "converters/library/rows/build_row.h"
#include "converters/library/rows/row_note.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kWorkMark = "lumen-library-build.txt";
constexpr const char* kMarkText =
    "lumen library build works here, and removes this folder when all is made.\n";
// a batch waits this multiple of the time that the last one took to put in
constexpr double kPatience = 20;

/// Whether a case records corrections by hand that can be made again (base/options/edit_steps.h).
bool hasCorrections(const CaseRecord& record) {
  for (const auto& step : record.provenance.value("steps", nlohmann::ordered_json::array()))
    if (step.value("name", "") == kEditStep)
      for (const auto& [name, value] : step.at("parameters").items())
        if (isRequestName(name)) return true;
  return false;
}

/// The library's version of a case, if it was corrected by hand.
fs::path correctedVersion(const fs::path& folder, const LibraryFile& library,
                          const std::string& id) {
  if (findCase(library, id) == nullptr) return {};
  try {
    return hasCorrections(recordIn(folder, id)) ? folder / kPayload / id / kCaseFile : fs::path();
  } catch (const Error&) {
    return {};
  }
}

/// A case that was made, as the only one of a library in the row's folder.
struct StagedCase {
  std::string id;
  fs::path folder, library;
};

/// Puts cases into the library as one revision, and removes the folders of their rows.
void putStaged(const std::vector<StagedCase>& cases, const fs::path& library,
               const std::string& day, Progress& progress) {
  LibraryChange change(library, progress);
  for (const StagedCase& one : cases)
    change.addOrReplace(recordIn(one.library, one.id), one.library / kPayload / one.id);
  change.commit(day);
  std::error_code ignored;
  for (const StagedCase& one : cases) fs::remove_all(one.folder, ignored);
}

/// Results that workers hand over, and rows that lie ready for the library.
class LibraryBuild {
public:
  LibraryBuild(const std::vector<BuildRow>& rows, fs::path folder, const BuildOptions& options,
               Progress& progress)
      : m_rows(rows),
        m_folder(std::move(folder)),
        m_library(openLibrary(m_folder)),
        m_options(options),
        m_progress(progress),
        m_results(rows.size()) {}

  std::vector<RowResult> run() {
    m_progress.begin("building", m_rows.size());
    {
      std::vector<std::jthread> workers;  // joined here, however this ends
      try {
        start(workers);
        putAll();
      } catch (...) {
        m_next = m_rows.size();  // rows that run end, no other begins
        throw;
      }
    }
    m_progress.check();
    m_progress.end();
    return std::move(m_results);
  }

private:
  void start(std::vector<std::jthread>& workers) {
    m_working = m_options.jobs;
    try {
      for (int k = 0; k < m_options.jobs; ++k) workers.emplace_back([this] { work(); });
    } catch (const std::system_error& error) {
      throw failed("a thread for a row cannot be started: " + error.code().message());
    }
  }

  void work() {
    for (std::size_t i = m_next++; i < m_rows.size() && !m_progress.cancelled(); i = m_next++) {
      try {
        makeOne(i);
      } catch (const Error& error) {
        failUnmade(i, error);
      } catch (const std::exception& error) {
        failUnmade(i, failed(error.what()));
      }
      m_progress.advance();
    }
    const std::lock_guard lock(m_mutex);
    --m_working;
    m_changed.notify_all();
  }

  void makeOne(std::size_t i) {
    m_results[i].line = m_rows[i].line;
    m_results[i].id = m_rows[i].id;
    if (isResumedRow(m_rows[i], m_library, m_options)) {
      m_results[i].state = RowState::Kept;
      return;
    }
    PlannedRow plan = planRow(m_rows[i], m_library, m_options, m_progress);
    m_results[i].id = plan.id;
    if (const std::size_t first = firstLineOf(plan); first != plan.row->line) {
      fail(i, invalidInput(inputIsThatOf(first)));
      return;
    }
    if (isMadeFrom(m_folder, m_library, plan.id, plan.recipe.all)) {
      m_results[i].state = RowState::Kept;
      leaveNote(i, &plan);
      return;
    }
    plan.corrected = correctedVersion(m_folder, m_library, plan.id);
    makeAlone(i, plan);
    if (m_results[i].state != RowState::Made || m_options.phase != BuildPhase::All) return;
    const std::lock_guard lock(m_mutex);
    m_ready.push_back({plan.id, plan.folder, plan.staged});
    m_changed.notify_all();
  }

  /// Makes a row while no other process does.
  void makeAlone(std::size_t i, const PlannedRow& plan) {
    const RowLock lock(plan.folder, m_progress);
    m_results[i].state = RowState::Running;
    leaveNote(i, &plan);
    m_results[i] = makeRow(plan, m_library, m_options);
    leaveNote(i, &plan);
    if (m_results[i].state != RowState::Made) warnOfRow(m_progress, m_results[i]);
  }

  /// The line of the first row with this id.
  std::size_t firstLineOf(const PlannedRow& plan) {
    const std::lock_guard lock(m_mutex);
    return m_ids.emplace(plan.id, plan.row->line).first->second;
  }

  void leaveNote(std::size_t i, const PlannedRow* plan) {
    RowNote note{m_results[i], "", "", "", m_options.place};
    if (plan != nullptr) {
      note.recipe = plan->recipe.all;
      note.folder = plan->folder.filename().string();
      note.staged = plan->staged.filename().string();
    }
    writeNote(m_options.work, noteName(m_rows[i], m_options.version, m_library.licence), note);
  }

  /// A row that failed before it was begun, or whose notes cannot be written.
  void failUnmade(std::size_t i, const Error& error) {
    fail(i, error);
    if (m_progress.cancelled()) return;
    try {
      leaveNote(i, nullptr);
    } catch (const Error& second) {
      m_progress.detail(second.what());  // the disk is full: the first reason is the row's
    }
  }

  void fail(std::size_t i, const Error& error) {
    m_results[i].state = RowState::Failed;
    m_results[i].why = error.what();
    m_results[i].code = static_cast<int>(error.kind());
    if (!m_progress.cancelled()) warnOfRow(m_progress, m_results[i]);
  }

  /// Puts batches into the library until nobody works any more.
  void putAll() {
    double cost = 0;  // s
    for (Clock::time_point last = Clock::now();;) {
      std::vector<StagedCase> batch;
      {
        std::unique_lock lock(m_mutex);
        m_changed.wait_for(lock, std::chrono::milliseconds(200));
        m_progress.check();
        const std::chrono::duration<double> waited = Clock::now() - last;
        const bool isLast = m_working == 0;
        if (isLast && m_ready.empty()) return;
        if (m_ready.empty() || (!isLast && waited.count() < kPatience * cost)) continue;
        batch.swap(m_ready);
      }
      const Clock::time_point begin = Clock::now();
      putStaged(batch, m_folder, m_options.day, m_progress);
      last = Clock::now();
      cost = std::chrono::duration<double>(last - begin).count();
    }
  }

  const std::vector<BuildRow>& m_rows;
  fs::path m_folder;
  LibraryFile m_library;  ///< as it was at the beginning
  const BuildOptions& m_options;
  Progress& m_progress;
  std::vector<RowResult> m_results;
  std::atomic<std::size_t> m_next{0};
  std::mutex m_mutex;
  std::condition_variable m_changed;
  int m_working = 0;
  std::vector<StagedCase> m_ready;
  std::map<std::string, std::size_t> m_ids;  ///< and whose they are
};

std::string whyNotMade(const RowStatus& row) {
  if (row.state == RowState::Running) return "is being made still, by " + row.note->place;
  if (row.state == RowState::Interrupted)
    return "its process ended before the case was made: " + row.note->place;
  if (row.state == RowState::Failed) return row.note->result.why;
  return row.note ? "was made, but its case is gone" : "no process has begun it";
}

/// Cases that other processes left in the folder for work, put into the library in one step. A row
/// that no process made is Failed, with the reason.
class Collection {
public:
  Collection(const std::vector<BuildRow>& rows, const fs::path& library,
             const BuildOptions& options, Progress& progress)
      : m_rows(rows), m_folder(library), m_options(options), m_progress(progress) {}

  std::vector<RowResult> run() {
    const LibraryFile library = openLibrary(m_folder);
    std::vector<RowResult> results;
    for (const RowStatus& row : rowStates(m_rows, m_folder, m_options)) {
      m_progress.check();
      results.push_back(resultOf(row, library));
      const RowState state = results.back().state;
      if (state == RowState::Failed || state == RowState::NeedsPerson)
        warnOfRow(m_progress, results.back());
    }
    if (!m_staged.empty()) putStaged(m_staged, m_folder, m_options.day, m_progress);
    return results;
  }

private:
  RowResult resultOf(const RowStatus& row, const LibraryFile& library) {
    RowResult result = row.note ? row.note->result : RowResult{};
    result.line = row.row->line;
    if (result.id.empty()) result.id = row.row->id;
    const bool isMade = row.state == RowState::Made;
    if (isResumedRow(*row.row, library, m_options) && !isMade) {
      result.state = RowState::Kept;
      return result;
    }
    if (row.state == RowState::NeedsPerson) return result;
    if (!row.note || (!isMade && row.state != RowState::Kept))
      return failure(std::move(result), whyNotMade(row), ErrorKind::Failed);
    const auto [first, isNew] = m_ids.emplace(result.id, result.line);
    if (!isNew)
      return failure(std::move(result), inputIsThatOf(first->second), ErrorKind::InvalidInput);
    result.state = row.state;
    const fs::path folder = m_options.work / row.note->folder;
    if (isMade) m_staged.push_back({result.id, folder, folder / row.note->staged});
    return result;
  }

  static RowResult failure(RowResult result, const std::string& why, ErrorKind kind) {
    result.state = RowState::Failed;
    result.why = why;
    if (result.code == 0) result.code = static_cast<int>(kind);
    return result;
  }

  const std::vector<BuildRow>& m_rows;
  fs::path m_folder;
  const BuildOptions& m_options;
  Progress& m_progress;
  std::map<std::string, std::size_t> m_ids;  ///< and the lines that have them
  std::vector<StagedCase> m_staged;
};

}  // namespace

void claimWorkFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const bool isEmpty = !error && fs::is_empty(folder, error);
  if (!error && isEmpty) {
    writeNewFile(kMarkText, folder / kWorkMark);
  }
  if (error) throw failed(formats::printable(folder.string()) + ": " + error.message());
}

void removeWorkFolder(const fs::path& folder) {
  std::error_code ignored;
  const fs::path mark = folder / kWorkMark;
  if (fs::is_regular_file(mark, ignored) && readWholeFile(mark, "mark") == kMarkText)
    fs::remove_all(folder, ignored);
}

std::vector<RowResult> buildLibrary(const std::vector<BuildRow>& rows, const fs::path& library,
                                    const BuildOptions& options, Progress& progress) {
  claimWorkFolder(options.work);
  if (options.phase == BuildPhase::Collect)
    return Collection(rows, library, options, progress).run();
  return LibraryBuild(rows, library, options, progress).run();
}

}  // namespace lumen::convert
