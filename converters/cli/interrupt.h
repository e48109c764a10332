// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, SIGTERM, and the end of the terminal (SIGHUP).
#pragma once

#include <thread>

#include <pthread.h>

#include "converters/base/progress.h"

namespace lumen {

/// A write beyond the shell's limit on the size of a file (ulimit -f) fails as on a full disk,
/// instead of ending the process without a message.
void reportFileSizeLimit();

/// While the guard lives, the first SIGINT, SIGTERM or SIGHUP cancels `progress`. If the process is
/// still there 0.8 s later (inside a library call that cannot be stopped), or at a second signal,
/// it exits with code 130 at once. Before that exit the process's temporary files are removed; its
/// outputs are whole, because they only ever appear by a rename. A process that was started with
/// SIGHUP ignored (nohup) goes on at that signal.
///
/// Construct one before any other thread starts: threads inherit the blocked signals, and a thread
/// of the guard waits for them, so no code runs inside a signal handler.
class InterruptGuard {
public:
  explicit InterruptGuard(Progress& progress);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

private:
  void wait();
  [[noreturn]] void exitNow();

  Progress& m_progress;
  std::thread m_thread;
};

}  // namespace lumen
