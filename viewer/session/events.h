// SPDX-License-Identifier: Apache-2.0
// Events for every page that listens.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"

namespace lumen::viewer {

using engine::Json;

struct Event {
  std::string name;  ///< "state", "progress", "message" or "done"
  std::string data;  ///< JSON, one line
};

/// One page's queue. All calls are thread-safe.
class Listener {
public:
  /// The next event, or nothing if none comes in time.
  std::optional<Event> wait(std::chrono::milliseconds most);
  /// True if no more events will come.
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

  /// Null if there are kMostListeners already.
  std::shared_ptr<Listener> listen();
  /// The number of listeners: each counts while somebody holds it.
  [[nodiscard]] std::size_t count();
  void send(const std::string& name, const Json& data);
  /// Each event is handed to `hear` as it is sent, for a page in the same process. Once, before any
  /// other call.
  void forward(std::function<void(const Event&)> hear) { m_hear = std::move(hear); }
  void close();

private:
  std::function<void(const Event&)> m_hear;
  std::mutex m_mutex;
  std::vector<std::weak_ptr<Listener>> m_listeners;
  bool m_closed = false;
};

/// JSON on one line, as it goes over the wire; bytes that are not UTF-8 are replaced.
std::string jsonText(const Json& value);

}  // namespace lumen::viewer
