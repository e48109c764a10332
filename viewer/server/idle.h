// SPDX-License-Identifier: Apache-2.0
// When a viewer that nobody looks at ends.
#pragma once

#include <chrono>
#include <cstddef>

namespace lumen::viewer {

/// Told every now and then how many pages are open. It is over when there has been a page, and then
/// for long enough none, nor any work: a page that is loaded again takes seconds.
class IdleEnd {
public:
  using Clock = std::chrono::steady_clock;

  IdleEnd(Clock::duration longEnough, Clock::time_point now)
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
