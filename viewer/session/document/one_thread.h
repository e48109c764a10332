// SPDX-License-Identifier: Apache-2.0
// A session whose owner has one thread, as WebAssembly has it: jobs and surfaces are made when the owner calls Session::work(),
// and whoever wants them to end is asked as they advance.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <utility>

#include "converters/base/progress.h"

namespace lumen::viewer {

struct OneThread {
  std::function<bool()> isJobStopped;      ///< true: the running job ends, and changes nothing
  std::function<bool()> isSurfaceStopped;  ///< true: the surface is made later, a request waits
};

/// Asks at most five times a second. All calls are thread-safe.
class StopQuestion {
public:
  /// Null: nobody is asked.
  explicit StopQuestion(std::function<bool()> isStopped) : m_isStopped(std::move(isStopped)) {}

  /// Cancels `progress` if the answer is true.
  void ask(Progress& progress) {
    if (!m_isStopped) return;
    auto next = m_next.load();
    if (Clock::now().time_since_epoch().count() < next) return;
    const auto then = Clock::now() + std::chrono::milliseconds(200);
    if (m_next.compare_exchange_strong(next, then.time_since_epoch().count()) && m_isStopped())
      progress.cancel();
  }

private:
  using Clock = std::chrono::steady_clock;

  const std::function<bool()> m_isStopped;
  std::atomic<Clock::rep> m_next{0};
};

}  // namespace lumen::viewer
