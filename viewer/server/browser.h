// SPDX-License-Identifier: Apache-2.0
// The user's browser.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace lumen::viewer {

/// Opens an address in the default browser, which goes on by itself. False if there is none.
bool openBrowser(const std::string& address);

// The end of a viewer without pages.

/// Decides by the number of open pages, which it gets at intervals. The viewer is over when there
/// was a page, and then neither a page nor work for long enough: reloading a page takes seconds.
class IdleTimeout {
public:
  using Clock = std::chrono::steady_clock;

  IdleTimeout(Clock::duration longEnough, Clock::time_point now)
      : m_longEnough(longEnough), m_last(now) {}

  bool isOver(std::size_t pages, bool isBusy, Clock::time_point now) {
    m_hadPage = m_hadPage || pages > 0;
    if (pages > 0 || isBusy) m_last = now;
    return m_hadPage && now - m_last > m_longEnough;
  }

private:
  const Clock::duration m_longEnough;
  Clock::time_point m_last;
  bool m_hadPage = false;
};

}  // namespace lumen::viewer
