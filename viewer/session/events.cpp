// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/events.h"

#include <algorithm>

namespace lumen::viewer {

namespace {

constexpr std::size_t kMostQueued = 256;

}  // namespace

std::optional<Event> Listener::wait(std::chrono::milliseconds most) {
  std::unique_lock lock(m_mutex);
  m_wake.wait_for(lock, most, [this] { return m_closed || !m_queue.empty(); });
  if (m_queue.empty()) return std::nullopt;
  Event event = std::move(m_queue.front());
  m_queue.pop_front();
  return event;
}

bool Listener::closed() const {
  const std::lock_guard lock(m_mutex);
  return m_closed && m_queue.empty();
}

void Listener::put(const Event& event) {
  const std::lock_guard lock(m_mutex);
  // only the newest state and the newest progress count
  if (event.name == "state" || event.name == "progress")
    std::erase_if(m_queue, [&event](const Event& e) { return e.name == event.name; });
  if (m_queue.size() >= kMostQueued) m_queue.pop_front();
  m_queue.push_back(event);
  m_wake.notify_all();
}

void Listener::close() {
  const std::lock_guard lock(m_mutex);
  m_closed = true;
  m_wake.notify_all();
}

std::shared_ptr<Listener> EventHub::listen() {
  const std::lock_guard lock(m_mutex);
  std::erase_if(m_listeners, [](const auto& l) { return l.expired(); });
  if (m_closed || m_listeners.size() >= kMostListeners) return nullptr;
  auto listener = std::make_shared<Listener>();
  m_listeners.push_back(listener);
  return listener;
}

std::size_t EventHub::count() {
  const std::lock_guard lock(m_mutex);
  std::erase_if(m_listeners, [](const auto& l) { return l.expired(); });
  return m_listeners.size();
}

void EventHub::send(const std::string& name, const Json& data) {
  const Event event{name, jsonText(data)};
  if (m_hear) m_hear(event);
  const std::lock_guard lock(m_mutex);
  for (const auto& weak : m_listeners)
    if (const auto listener = weak.lock()) listener->put(event);
}

void EventHub::close() {
  const std::lock_guard lock(m_mutex);
  m_closed = true;
  for (const auto& weak : m_listeners)
    if (const auto listener = weak.lock()) listener->close();
}

std::string jsonText(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lumen::viewer
