// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/watched_work.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include <tbb/global_control.h>

#include "converters/base/shown_text.h"
#include "packages/python/src/python_error.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

/// Interval between two looks for Ctrl-C: shorter than a person notices.
constexpr std::chrono::milliseconds kInterval{50};

struct StageState {
  std::string stage;
  std::size_t done = 0, total = 0;
  friend bool operator==(const StageState&, const StageState&) = default;
};

/// Keeps the newest state for the thread that watches.
class WatchedProgress : public Progress {
public:
  explicit WatchedProgress(bool strict) : m_strict(strict) {}

  void begin(std::string_view stage, std::size_t total) override {
    const std::lock_guard lock(m_mutex);
    m_state = {std::string(stage), 0, total};
  }
  void advance(std::size_t units) override {
    const std::lock_guard lock(m_mutex);
    m_state.done += units;
  }
  void detail(std::string_view message) override {
    const std::lock_guard lock(m_mutex);
    m_messages.details.push_back(messageText(message));
  }
  void warn(std::string_view message) override {
    if (m_strict)
      throw invalidInput(std::string(message) + " (a warning, which strict makes an error)");
    const std::lock_guard lock(m_mutex);
    m_messages.warnings.push_back(messageText(message));
  }

  [[nodiscard]] StageState state() const {
    const std::lock_guard lock(m_mutex);
    return m_state;
  }
  [[nodiscard]] Messages takeMessages() { return std::move(m_messages); }

private:
  mutable std::mutex m_mutex;
  StageState m_state;
  Messages m_messages;
  bool m_strict;
};

/// The thread of the work, which is joined with this object.
class Worker {
public:
  Worker(WatchedProgress& progress, const std::function<void(Progress&)>& work)
      : m_thread([this, &progress, &work] {
          std::exception_ptr failure;
          try {
            work(progress);
          } catch (...) {
            failure = std::current_exception();
          }
          const std::lock_guard lock(m_mutex);
          m_failure = failure;
          m_isDone = true;
          m_ended.notify_all();
        }) {}
  ~Worker() { m_thread.join(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// True if the work ends within the interval.
  bool wait() {
    std::unique_lock lock(m_mutex);
    return m_ended.wait_for(lock, kInterval, [this] { return m_isDone; });
  }
  /// Waits for the end. Throws what the work threw.
  void finish() {
    std::unique_lock lock(m_mutex);
    m_ended.wait(lock, [this] { return m_isDone; });
    if (m_failure) std::rethrow_exception(m_failure);
  }

private:
  std::mutex m_mutex;
  std::condition_variable m_ended;
  bool m_isDone = false;
  std::exception_ptr m_failure;
  std::thread m_thread;  // last, as it uses all others
};

/// Calls `report` if there is something new, and raises what a signal asks for.
void look(const py::object& report, const StageState& now, StageState& shown) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (report.is_none() || now == shown || now.stage.empty()) return;
  shown = now;
  report(now.stage, now.done, now.total);
}

/// Watches until the work has ended. Whatever is thrown meanwhile, by Python or by its binding,
/// cancels the work and is returned; null without one.
std::exception_ptr watchUntilEnd(Worker& worker, WatchedProgress& progress,
                                 const py::object& report) {
  try {
    StageState shown;
    for (bool hasEnded = false; !hasEnded;) {
      hasEnded = released([&] { return worker.wait(); });
      look(report, progress.state(), shown);
    }
    return nullptr;
  } catch (...) {
    progress.cancel();
    return std::current_exception();
  }
}

}  // namespace

Messages runWatched(const Watch& watch, const std::function<void(Progress&)>& work) {
  std::optional<tbb::global_control> control;
  if (watch.threads > 0)
    control.emplace(tbb::global_control::max_allowed_parallelism,
                    static_cast<std::size_t>(watch.threads));
  WatchedProgress progress(watch.strict);
  Worker worker(progress, work);
  const std::exception_ptr raised = watchUntilEnd(worker, progress, watch.report);
  std::optional<Error> failure;
  released([&] {
    try {
      worker.finish();
    } catch (const Error& error) {
      failure = error;
    } catch (const std::bad_alloc&) {
      if (!raised) throw;
    } catch (const std::exception& error) {
      failure = failed(std::string("unexpected: ") + error.what());
    }
  });
  if (raised) std::rethrow_exception(raised);
  if (failure) raise(*failure);
  return progress.takeMessages();
}

}  // namespace lumen::python
