// SPDX-License-Identifier: Apache-2.0
// Progress on standard error: a live bar with time left on a terminal, plain lines elsewhere.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

#include "converters/base/progress.h"

namespace lumen {

enum class Verbosity { Quiet, Normal, Verbose };

class TerminalProgress : public Progress {
public:
  /// Destination and form of the lines. `out` must outlive the object.
  struct Style {
    std::FILE* out = stderr;
    bool bar = false;  ///< redraw one line in place; only sensible on a terminal
    Verbosity verbosity = Verbosity::Normal;
    std::chrono::milliseconds barInterval{100};  ///< shortest time between two drawings of the bar
    std::chrono::milliseconds lineInterval{5000};  ///< shortest time between two plain lines
    bool strict = false;                           ///< a warning is an error
  };

  explicit TerminalProgress(const Style& style);
  ~TerminalProgress() override;

  /// A bar if `out` is a terminal that can redraw a line (TERM is set and not "dumb").
  static Style detectStyle(std::FILE* out, Verbosity verbosity);

  void begin(std::string_view stage, std::size_t total) override;
  void advance(std::size_t units = 1) override;
  void end() override;
  void detail(std::string_view message) override;
  /// Throws Error(InvalidInput) if the style is strict.
  void warn(std::string_view message) override;

  /// Drops the running stage without its closing line, so that a message begins on a clean line.
  void abandon();

private:
  using Clock = std::chrono::steady_clock;

  void drawLocked(Clock::time_point now);
  void lineLocked(std::string_view text);
  void endLocked();
  [[nodiscard]] double secondsSinceBegin(Clock::time_point now) const;

  const Style m_style;
  std::mutex m_mutex;  ///< guards everything below but the atomics
  std::string m_stage;
  bool m_running = false;
  bool m_barShown = false;
  Clock::time_point m_begin;
  std::atomic<std::size_t> m_total{0};
  std::atomic<std::size_t> m_done{0};
  std::atomic<Clock::rep> m_nextDraw{0};  ///< advance() takes the lock only after this moment
};

/// "7 s", "1:05" or "2:03:20", rounded to the second.
std::string formatDuration(double seconds);

/// "45 %  18 of 40  0:12 left", without the figures that are unknown; the estimate assumes that all
/// units cost the same.
std::string formatProgress(std::size_t done, std::size_t total, double seconds);

}  // namespace lumen
