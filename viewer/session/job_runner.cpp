// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/job_runner.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/free_memory.h"

namespace lumen::viewer {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kInterval{100};  // as often as a page redraws a bar

/// Reports to the pages how far a job is.
class JobProgress : public Progress {
public:
  JobProgress(EventHub& events, int job, std::function<bool()> isStopped)
      : m_events(events), m_job(job), m_stop(std::move(isStopped)) {}

  void begin(std::string_view stage, std::size_t total) override {
    {
      const std::lock_guard lock(m_mutex);
      m_stage = stage;
    }
    m_total = total;
    m_done = 0;
    m_stop.ask(*this);
    report();
  }

  void advance(std::size_t units) override {
    m_done += units;
    m_stop.ask(*this);
    const auto now = Clock::now().time_since_epoch().count();
    auto next = m_next.load();
    if (now < next) return;
    const auto then = now + std::chrono::duration_cast<Clock::duration>(kInterval).count();
    if (m_next.compare_exchange_strong(next, then)) report();
  }

  void warn(std::string_view message) override {
    m_events.send("message", {{"severity", "warning"}, {"text", messageText(message)}});
  }

private:
  void report() {
    std::string stage;
    {
      const std::lock_guard lock(m_mutex);
      stage = m_stage;
    }
    m_events.send(
        "progress",
        {{"job", m_job}, {"stage", stage}, {"done", m_done.load()}, {"total", m_total.load()}});
  }

  EventHub& m_events;
  const int m_job;
  StopQuestion m_stop;
  std::mutex m_mutex;  ///< guards the next
  std::string m_stage;
  std::atomic<std::size_t> m_total{0}, m_done{0};
  std::atomic<Clock::rep> m_next{0};
};

Conflict busyWith(const RunningJob& running) {
  return Conflict("busy with " + running.name + "; wait for its end, or cancel it");
}

}  // namespace

JobRunner::JobRunner(EventHub& events, std::function<void()> changed,
                     const std::optional<OneThread>& oneThread)
    : m_events(events), m_changed(std::move(changed)), m_oneThread(oneThread) {}

JobRunner::~JobRunner() {
  cancelAll();
  if (m_thread.joinable()) m_thread.join();
}

int JobRunner::start(const std::string& name, bool changes, Work work) {
  int job = 0;
  std::thread ended;
  {
    const std::lock_guard lock(m_mutex);
    if (m_running) throw busyWith(*m_running);
    job = ++m_last;
    m_progress = std::make_unique<JobProgress>(m_events, job,
                                               m_oneThread ? m_oneThread->isJobStopped : nullptr);
    m_running = RunningJob{job, name, changes};
    ended = std::move(m_thread);
  }
  // without the lock, which the last words of the ended job may need
  if (ended.joinable()) ended.join();
  try {
    m_changed();
    const std::lock_guard lock(m_mutex);
    auto all = [this, job, work = std::move(work), &progress = *m_progress] {
      run(job, work, progress);
    };
    if (m_oneThread)
      m_waiting = std::move(all);
    else
      m_thread = std::thread(std::move(all));
  } catch (...) {
    end();
    throw;
  }
  return job;
}

void JobRunner::requireNoChange() const {
  const std::lock_guard lock(m_mutex);
  if (m_running && m_running->changes) throw busyWith(*m_running);
}

void JobRunner::end() {
  {
    const std::lock_guard lock(m_mutex);
    m_running.reset();
  }
  m_ended.notify_all();
}

void JobRunner::run(int job, const Work& work, Progress& progress) {
  Json done = {{"job", job}, {"ok", false}};
  try {
    done["text"] = work(progress);
    done["ok"] = true;
  } catch (const Error& error) {
    const bool cancelled = error.kind() == ErrorKind::Cancelled;
    done["cancelled"] = cancelled;
    done["text"] =
        cancelled ? std::string("cancelled; nothing has changed") : messageText(error.what());
  } catch (const std::bad_alloc&) {
    done["text"] = "there is not enough memory";
  } catch (const std::exception& error) {
    done["text"] = messageText(std::string("unexpected: ") + error.what());
  }
  returnFreeMemory();
  end();
  try {
    m_events.send("done", done);
    m_changed();
  } catch (const std::exception&) {
    // without the memory for a message there is none; pages ask for the state again
  }
}

bool JobRunner::cancel(int job) {
  const std::lock_guard lock(m_mutex);
  if (!m_running || m_running->job != job) return false;
  m_progress->cancel();
  return true;
}

void JobRunner::cancelAll() {
  const std::lock_guard lock(m_mutex);
  if (m_progress) m_progress->cancel();
}

std::optional<RunningJob> JobRunner::running() const {
  const std::lock_guard lock(m_mutex);
  return m_running;
}

bool JobRunner::runWaiting() {
  std::function<void()> work;
  {
    const std::lock_guard lock(m_mutex);
    work = std::exchange(m_waiting, nullptr);
  }
  if (work) work();
  return work != nullptr;
}

void JobRunner::wait() {
  runWaiting();
  std::unique_lock lock(m_mutex);
  m_ended.wait(lock, [this] { return !m_running; });
}

}  // namespace lumen::viewer
