// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM.
#pragma once

#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include <pthread.h>

#include "converters/base/progress.h"

namespace lumen {

/// A write beyond the shell's limit on the size of a file (ulimit -f) fails like one to a full disk,
/// instead of ending the process without a word.
void reportFileSizeLimit();

/// While it lives, the first SIGINT or SIGTERM cancels `progress`; if the process is still there
/// 0.8 s later (inside a library call that cannot be stopped), or at a second signal, it exits with
/// code 130 at once. Before that exit the temporary files of the registered outputs are removed;
/// the outputs themselves are whole, because they only ever appear by a rename.
///
/// Construct one before any other thread starts: threads inherit the blocked signals, and a thread
/// of this object's own waits for them, so no code runs inside a signal handler.
class InterruptGuard {
public:
  explicit InterruptGuard(Progress& progress);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// `file` is going to be written through a temporary file beside it.
  void watchOutput(const std::filesystem::path& file);

private:
  void wait();
  [[noreturn]] void exitNow();

  Progress& m_progress;
  std::mutex m_mutex;
  std::vector<std::filesystem::path> m_folders;
  std::thread m_thread;
};

}  // namespace lumen
