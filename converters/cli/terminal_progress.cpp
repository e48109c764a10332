// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/terminal_progress.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

#include "converters/base/shown_text.h"

namespace lumen {

namespace {

constexpr std::size_t kBarWidth = 24;

std::size_t terminalColumns(std::FILE* out) {
  winsize size{};
  if (ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

std::string bar(std::size_t done, std::size_t total) {
  const std::size_t filled = std::min(done, total) * kBarWidth / total;
  std::string text(kBarWidth + 2, '.');
  std::fill_n(text.begin() + 1, filled, '#');
  text.front() = '[';
  text.back() = ']';
  return text;
}

}  // namespace

std::string formatDuration(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  std::array<char, 48> text{};
  if (whole < 60)
    std::snprintf(text.data(), text.size(), "%ld s", whole);
  else if (whole < 3600)
    std::snprintf(text.data(), text.size(), "%ld:%02ld", whole / 60, whole % 60);
  else
    std::snprintf(text.data(), text.size(), "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60,
                  whole % 60);
  return text.data();
}

std::string formatProgress(std::size_t done, std::size_t total, double seconds) {
  if (total == 0) return (done > 0 ? std::to_string(done) + "  " : "") + formatDuration(seconds);
  const std::size_t shown = std::min(done, total);
  std::string text = std::to_string(shown * 100 / total) + " %  " + std::to_string(shown) + " of " +
                     std::to_string(total);
  if (shown > 0 && shown < total) {
    const double left = seconds * static_cast<double>(total - shown) / static_cast<double>(shown);
    text += "  " + formatDuration(left) + " left";
  }
  return text;
}

TerminalProgress::TerminalProgress(const Style& style) : m_style(style) {}

TerminalProgress::~TerminalProgress() {
  abandon();
}

TerminalProgress::Style TerminalProgress::detectStyle(std::FILE* out, Verbosity verbosity) {
  Style style;
  style.out = out;
  style.verbosity = verbosity;
  const char* term = std::getenv("TERM");
  style.bar = isatty(fileno(out)) == 1 && term != nullptr && std::string_view(term) != "dumb";
  return style;
}

void TerminalProgress::begin(std::string_view stage, std::size_t total) {
  if (m_style.verbosity == Verbosity::Quiet) return;
  const std::lock_guard lock(m_mutex);
  if (m_running) endLocked();
  m_stage = stage;
  m_running = true;
  m_total = total;
  m_done = 0;
  m_begin = Clock::now();
  // the first plain line waits for its interval: a short stage prints only its closing line
  const auto wait = m_style.bar ? m_style.barInterval : m_style.lineInterval;
  m_nextDraw = (m_begin + wait).time_since_epoch().count();
  if (m_style.bar) drawLocked(m_begin);
}

void TerminalProgress::advance(std::size_t units) {
  m_done.fetch_add(units, std::memory_order_relaxed);
  if (m_style.verbosity == Verbosity::Quiet) return;
  const auto now = Clock::now();
  if (now.time_since_epoch().count() < m_nextDraw.load(std::memory_order_relaxed)) return;
  const std::unique_lock lock(m_mutex, std::try_to_lock);
  if (lock.owns_lock() && m_running) drawLocked(now);
}

void TerminalProgress::end() {
  const std::lock_guard lock(m_mutex);
  endLocked();
}

void TerminalProgress::detail(std::string_view message) {
  if (m_style.verbosity != Verbosity::Verbose) return;
  const std::lock_guard lock(m_mutex);
  lineLocked("lumen: " + messageText(message));
}

void TerminalProgress::warn(std::string_view message) {
  if (m_style.strict)
    throw invalidInput(std::string(message) + " (a warning, which --strict makes an error)");
  if (m_style.verbosity == Verbosity::Quiet) return;
  const std::lock_guard lock(m_mutex);
  lineLocked("lumen: warning: " + messageText(message));
}

void TerminalProgress::abandon() {
  const std::lock_guard lock(m_mutex);
  if (m_barShown) std::fputs("\r\x1b[K", m_style.out);
  std::fflush(m_style.out);
  m_barShown = m_running = false;
}

void TerminalProgress::endLocked() {
  if (!m_running) return;
  m_running = false;
  const std::string took = formatDuration(secondsSinceBegin(Clock::now()));
  const std::size_t total = m_total;
  std::string text = m_stage + ": done in " + took;
  if (total > 0) text.append(" (").append(std::to_string(total)).append(")");
  lineLocked(text);
}

void TerminalProgress::drawLocked(Clock::time_point now) {
  const auto wait = m_style.bar ? m_style.barInterval : m_style.lineInterval;
  m_nextDraw = (now + wait).time_since_epoch().count();
  const std::size_t total = m_total, done = m_done;
  const std::string figures = formatProgress(done, total, secondsSinceBegin(now));
  if (!m_style.bar) {
    std::fprintf(m_style.out, "%s: %s\n", m_stage.c_str(), figures.c_str());
    std::fflush(m_style.out);
    return;
  }
  std::string text = m_stage + "  " + (total > 0 ? bar(done, total) + "  " : "") + figures;
  const std::size_t columns = terminalColumns(m_style.out);
  // a line that wraps could not be redrawn in place
  if (text.size() >= columns) text.resize(columns - 1);
  std::fprintf(m_style.out, "\r\x1b[K%s", text.c_str());
  std::fflush(m_style.out);
  m_barShown = true;
}

void TerminalProgress::lineLocked(std::string_view text) {
  if (m_barShown) std::fputs("\r\x1b[K", m_style.out);
  m_barShown = false;
  std::fprintf(m_style.out, "%.*s\n", static_cast<int>(text.size()), text.data());
  std::fflush(m_style.out);
  if (m_running && m_style.bar) drawLocked(Clock::now());
}

double TerminalProgress::secondsSinceBegin(Clock::time_point now) const {
  return std::chrono::duration<double>(now - m_begin).count();
}

}  // namespace lumen
