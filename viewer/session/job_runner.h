// SPDX-License-Identifier: Apache-2.0
// Work that takes long: one piece at a time, on a thread of its own, with progress and an end.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "converters/base/progress.h"
#include "viewer/session/document/one_thread.h"
#include "viewer/session/events.h"

namespace lumen::viewer {

struct RunningJob {
  int job = 0;           ///< from 1 on, never used again
  std::string name;      ///< for people, such as "tracking"
  bool changes = false;  ///< it will change the document
};

/// All calls are thread-safe.
class JobRunner {
public:
  /// Throws as a stage; returns the sentence that reports the outcome.
  using Work = std::function<std::string(Progress&)>;

  /// `changed` is called, without any lock, when a job has begun or ended. With `oneThread` a job
  /// waits for runWaiting().
  JobRunner(EventHub& events, std::function<void()> changed,
            const std::optional<OneThread>& oneThread = {});
  /// Cancels the running job and waits for its end.
  ~JobRunner();
  JobRunner(const JobRunner&) = delete;
  JobRunner& operator=(const JobRunner&) = delete;

  /// The number of the job, which begins at once. `changes` belongs to the job from its first
  /// moment on. Throws Conflict while another runs.
  int start(const std::string& name, bool changes, Work work);
  /// Throws Conflict while a job runs that will change the document.
  void requireNoChange() const;
  /// False if no job of that number runs.
  bool cancel(int job);
  void cancelAll();
  [[nodiscard]] std::optional<RunningJob> running() const;
  /// Returns when nothing runs.
  void wait();
  /// Runs the job that waits for it, to its end. False if there is none.
  bool runWaiting();

private:
  void run(int job, const Work& work, Progress& progress);
  void end();

  EventHub& m_events;
  const std::function<void()> m_changed;
  const std::optional<OneThread> m_oneThread;
  mutable std::mutex m_mutex;  ///< guards all that follow
  std::condition_variable m_ended;
  std::optional<RunningJob> m_running;
  std::unique_ptr<Progress> m_progress;  ///< progress of the job that runs, or of the last
  std::function<void()> m_waiting;       ///< with one thread: the job that has not begun
  std::thread m_thread;
  int m_last = 0;
};

}  // namespace lumen::viewer
