// SPDX-License-Identifier: Apache-2.0
// What happens, told to every page that listens.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "converters/engine/report.h"

namespace lumen::viewer {

using app::Json;

struct Event {
  std::string name;  ///< "state", "progress", "message" or "done"
  std::string data;  ///< JSON, one line
};

/// One page's queue. All calls are thread-safe.
class Listener {
public:
  /// The next event, or nothing if none comes in time.
  std::optional<Event> wait(std::chrono::milliseconds most);
  /// No more events will come.
  [[nodiscard]] bool closed() const;

private:
  friend class EventHub;
  void put(const Event& event);
  void close();

  mutable std::mutex m_mutex;
  std::condition_variable m_wake;
  std::deque<Event> m_queue;
  bool m_closed = false;
};

/// All calls are thread-safe. A page that does not read loses its oldest events, never a new state.
class EventHub {
public:
  static constexpr std::size_t kMostListeners = 16;

  /// Null if there are as many already as there may be.
  std::shared_ptr<Listener> listen();
  /// How many there are: each is one as long as somebody holds it.
  [[nodiscard]] std::size_t count();
  void tell(const std::string& name, const Json& data);
  void close();

private:
  std::mutex m_mutex;
  std::vector<std::weak_ptr<Listener>> m_listeners;
  bool m_closed = false;
};

/// JSON as it goes over the wire, on one line; what is no UTF-8 is replaced.
std::string jsonText(const Json& value);

}  // namespace lumen::viewer
