// SPDX-License-Identifier: Apache-2.0
// Progress and cancellation of long work.
#pragma once

#include <atomic>
#include <cstddef>
#include <string_view>

#include "converters/base/error.h"

namespace lumen {

/// Handed to every long stage. The default object is silent and never cancelled. All calls are
/// thread-safe.
class Progress {
public:
  Progress() = default;
  virtual ~Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A stage begins; `total` units of work lie ahead (0: unknown).
  virtual void begin(std::string_view /*stage*/, std::size_t /*total*/) {}
  /// `units` more are done.
  virtual void advance(std::size_t /*units*/ = 1) {}
  virtual void end() {}
  /// A line for --verbose.
  virtual void detail(std::string_view /*message*/) {}
  /// A line that is shown unless --quiet.
  virtual void warn(std::string_view /*message*/) {}

  void cancel() noexcept { m_cancelled.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept {
    return m_cancelled.load(std::memory_order_relaxed);
  }
  /// Throws Error(Cancelled) after cancel(). Call it at least every 100 ms of work.
  void check() const {
    if (cancelled()) throw Error(ErrorKind::Cancelled, "interrupted");
  }

private:
  std::atomic<bool> m_cancelled{false};
};

}  // namespace lumen
