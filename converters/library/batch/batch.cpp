// SPDX-License-Identifier: Apache-2.0
#include "converters/library/batch/batch.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <unistd.h>

#include "converters/base/error.h"
#include "converters/base/warning.h"
#include "converters/library/batch/batch_case.h"
#include "converters/library/batch/batch_tables.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

/// Memory for all rows together: three quarters of the machine's.
std::uint64_t memoryForRows() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || size <= 0) return UINT64_MAX;
  return static_cast<std::uint64_t>(pages) / 4 * 3 * static_cast<std::uint64_t>(size);
}

class Batch {
public:
  Batch(const std::vector<BatchInput>& inputs, fs::path folder, const BuildOptions& options,
        Progress& progress)
      : m_inputs(inputs),
        m_folder(std::move(folder)),
        m_options(options),
        m_progress(progress),
        m_waiting(inputs.size()),
        m_result(inputs.size()),
        m_memory(memoryForRows()) {
    std::iota(m_waiting.begin(), m_waiting.end(), std::size_t{0});
    std::stable_sort(m_waiting.begin(), m_waiting.end(), [&](std::size_t a, std::size_t b) {
      return inputs[a].voxels > inputs[b].voxels;
    });
  }

  std::vector<BatchResult> run() {
    m_progress.begin("cases", m_inputs.size());
    try {
      makeAll();
    } catch (const Error&) {
      writeTables();
      throw;
    }
    writeTables();
    m_progress.check();
    if (m_fault) std::rethrow_exception(m_fault);
    m_progress.end();
    return finished();
  }

private:
  void writeTables() const {
    if (m_options.phase != BuildPhase::Make) writeBatchTables(finished(), m_folder);
  }

  void makeAll() {
    std::vector<std::jthread> workers;  // joined here, however this ends
    const std::size_t count = std::min<std::size_t>(static_cast<std::size_t>(m_options.jobs),
                                                    std::max<std::size_t>(1, m_inputs.size()));
    try {
      for (std::size_t k = 0; k < count; ++k) workers.emplace_back([this] { work(); });
    } catch (const std::system_error& error) {
      if (workers.empty())
        throw failed("a thread for a case cannot be started: " + error.code().message());
    }
  }

  /// An exception of a worker, such as a warning that is an error, ends the others, too.
  void work() {
    try {
      while (const std::optional<std::size_t> next = take()) give(*next, makeOne(m_inputs[*next]));
    } catch (...) {
      const std::lock_guard lock(m_mutex);
      if (!m_fault) m_fault = std::current_exception();
      m_waiting.clear();
    }
  }

  BatchResult makeOne(const BatchInput& input) {
    BatchResult result;
    result.id = input.row.id;
    result.name = input.name;
    result.code = static_cast<int>(ErrorKind::InvalidInput);
    result.why = input.fault;
    if (!input.fault.empty()) return result;
    try {
      return makeBatchCase(input, m_folder, m_options, m_progress);
    } catch (const Error& error) {
      result.code = static_cast<int>(error.kind());
      result.why = error.what();
    } catch (const std::exception& error) {
      result.code = static_cast<int>(ErrorKind::Failed);
      result.why = error.what();
    }
    return result;
  }

  /// The largest input that memory has room for beside those that run; any one where none runs.
  /// Waits for room; nothing where no input is left.
  std::optional<std::size_t> take() {
    std::unique_lock lock(m_mutex);
    while (!m_waiting.empty() && !m_progress.cancelled()) {
      const auto fits = std::find_if(m_waiting.begin(), m_waiting.end(), [this](std::size_t i) {
        return m_running == 0 || m_used + batchMemory(m_inputs[i].voxels) <= m_memory;
      });
      if (fits == m_waiting.end()) {
        m_changed.wait_for(lock, std::chrono::milliseconds(200));
        continue;
      }
      const std::size_t next = *fits;
      m_waiting.erase(fits);
      m_used += batchMemory(m_inputs[next].voxels);
      ++m_running;
      return next;
    }
    return std::nullopt;
  }

  void give(std::size_t i, BatchResult result) {
    const bool isDoubtful = result.end != BatchEnd::Passed && !m_progress.cancelled();
    const std::string doubt =
        formats::printable(result.name) + ": " + batchWord(result.end) + ": " + result.why;
    finish(i, std::move(result));
    if (isDoubtful) warn(m_progress, {WarningCode::BatchDoubt, doubt});
  }

  void finish(std::size_t i, BatchResult result) {
    const std::lock_guard lock(m_mutex);
    if (!m_progress.cancelled()) m_result[i] = std::move(result);
    m_used -= batchMemory(m_inputs[i].voxels);
    --m_running;
    m_changed.notify_all();
    m_progress.advance();
  }

  [[nodiscard]] std::vector<BatchResult> finished() const {
    std::vector<BatchResult> results;
    for (const std::optional<BatchResult>& result : m_result)
      if (result) results.push_back(*result);
    return results;
  }

  const std::vector<BatchInput>& m_inputs;
  fs::path m_folder;
  const BuildOptions& m_options;
  Progress& m_progress;
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::vector<std::size_t> m_waiting;  ///< the largest first
  std::vector<std::optional<BatchResult>> m_result;
  std::uint64_t m_memory, m_used = 0;
  std::size_t m_running = 0;
  std::exception_ptr m_fault;  ///< of a worker
};

}  // namespace

const char* batchWord(BatchEnd end) {
  switch (end) {
    case BatchEnd::Passed:
      return "passed";
    case BatchEnd::NeedsPerson:
      return "needs a person";
    case BatchEnd::NoVessels:
      return "no vessels";
    case BatchEnd::Failed:
      break;
  }
  return "failed";
}

std::vector<std::string> viewWords(const BatchResult& result, const std::string& volume,
                                   const std::string& caseFile) {
  if (result.at.empty()) return {};
  return {"lumen", "view", volume, caseFile, result.at};
}

fs::path batchCase(const std::string& id) {
  return id + ".lumen";
}

fs::path batchPicture(const std::string& id) {
  return fs::path("pictures") / (id + ".png");
}

fs::path batchLog(const std::string& id) {
  return fs::path("logs") / (id + ".log");
}

std::uint64_t batchMemory(std::uint64_t voxels) {
  // a process with its libraries, and for each voxel the fields and sets of finding in CT
  constexpr std::uint64_t kOfProcess = 66'000'000, kOfVoxel = 32;
  return kOfProcess + kOfVoxel * voxels;
}

std::vector<BatchResult> makeBatch(const std::vector<BatchInput>& inputs, const fs::path& folder,
                                   const BuildOptions& options, Progress& progress) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw failed(formats::printable(folder.string()) + ": " + error.message());
  return Batch(inputs, folder, options, progress).run();
}

}  // namespace lumen::convert
