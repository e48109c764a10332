// SPDX-License-Identifier: Apache-2.0
#include "converters/library/build.h"

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

#include "converters/base/edit_steps.h"
#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/library/build_row.h"
#include "converters/library/change.h"
#include "converters/library/collect_rows.h"
#include "converters/library/library_file.h"
#include "converters/library/library_lock.h"
#include "converters/library/row_state.h"
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

/// Whether a case records corrections by hand that can be made again (base/edit_steps.h).
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
      m_results[i].end = RowEnd::Kept;
      return;
    }
    PlannedRow plan = planRow(m_rows[i], m_library, m_options, m_progress);
    m_results[i].id = plan.id;
    if (const std::size_t first = firstLineOf(plan); first != plan.row->line) {
      fail(i, invalidInput(inputIsThatOf(first)));
      return;
    }
    if (isMadeFrom(m_folder, m_library, plan.id, plan.recipe.all)) {
      m_results[i].end = RowEnd::Kept;
      leaveNote(i, &plan, RowNote::State::Kept);
      return;
    }
    plan.corrected = correctedVersion(m_folder, m_library, plan.id);
    makeAlone(i, plan);
    if (m_results[i].end != RowEnd::Made || m_options.phase != BuildPhase::All) return;
    const std::lock_guard lock(m_mutex);
    m_ready.push_back(std::move(plan));
    m_changed.notify_all();
  }

  /// Makes a row while no other process does.
  void makeAlone(std::size_t i, const PlannedRow& plan) {
    const RowLock lock(plan.folder, m_progress);
    leaveNote(i, &plan, RowNote::State::Running);
    m_results[i] = makeRow(plan, m_library, m_options, m_progress);
    leaveNote(i, &plan, RowNote::stateOf(m_results[i].end));
    if (m_results[i].end != RowEnd::Made) warnOfRow(m_progress, m_results[i]);
  }

  /// The line of the first row with this id.
  std::size_t firstLineOf(const PlannedRow& plan) {
    const std::lock_guard lock(m_mutex);
    return m_ids.emplace(plan.id, plan.row->line).first->second;
  }

  void leaveNote(std::size_t i, const PlannedRow* plan, RowNote::State state) {
    RowNote note{state, m_results[i], "", "", "", m_options.place};
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
      leaveNote(i, nullptr, RowNote::State::Failed);
    } catch (const Error& second) {
      m_progress.detail(second.what());  // the disk is full: the first reason is the row's
    }
  }

  void fail(std::size_t i, const Error& error) {
    m_results[i].end = RowEnd::Failed;
    m_results[i].why = error.what();
    m_results[i].code = static_cast<int>(error.kind());
    if (!m_progress.cancelled()) warnOfRow(m_progress, m_results[i]);
  }

  /// Puts batches into the library until nobody works any more.
  void putAll() {
    double cost = 0;  // s
    for (Clock::time_point last = Clock::now();;) {
      std::vector<PlannedRow> batch;
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
      put(batch);
      last = Clock::now();
      cost = std::chrono::duration<double>(last - begin).count();
    }
  }

  void put(const std::vector<PlannedRow>& batch) {
    LibraryChange change(m_folder, m_progress);
    for (const PlannedRow& plan : batch)
      change.addOrReplace(recordIn(plan.staged, plan.id), plan.staged / kPayload / plan.id);
    change.commit(m_options.day);
    std::error_code ignored;
    for (const PlannedRow& plan : batch) fs::remove_all(plan.folder, ignored);
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
  std::vector<PlannedRow> m_ready;
  std::map<std::string, std::size_t> m_ids;  ///< and whose they are
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
  if (options.phase == BuildPhase::Collect) return collectRows(rows, library, options, progress);
  return LibraryBuild(rows, library, options, progress).run();
}

}  // namespace lumen::convert
