// SPDX-License-Identifier: Apache-2.0
// Progress of an operation that runs within another one, which hears of it.
#pragma once

#include <atomic>
#include <cstddef>
#include <string_view>

#include "converters/base/progress.h"

namespace lumen {

/// Passes all on, and counts warnings.
class CountingProgress : public Progress {
public:
  explicit CountingProgress(Progress& shown) : m_shown(shown) {}
  void begin(std::string_view stage, std::size_t total) override { m_shown.begin(stage, total); }
  void advance(std::size_t units) override { m_shown.advance(units); }
  void end() override { m_shown.end(); }
  void detail(std::string_view message) override { m_shown.detail(message); }
  void warn(std::string_view message) override {
    ++m_warnings;
    m_shown.warn(message);
  }
  [[nodiscard]] std::size_t warnings() const { return m_warnings; }

private:
  Progress& m_shown;
  std::atomic<std::size_t> m_warnings{0};
};

/// Shows nothing, and stops where the operation around it is cancelled.
class QuietProgress : public Progress {
public:
  explicit QuietProgress(const Progress& asked) : m_asked(asked) {}
  void begin(std::string_view, std::size_t) override { m_asked.check(); }
  void advance(std::size_t) override { m_asked.check(); }
  void end() override { m_asked.check(); }

private:
  const Progress& m_asked;
};

}  // namespace lumen
