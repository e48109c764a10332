// SPDX-License-Identifier: Apache-2.0
#include "converters/api/handle.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include <tbb/task_arena.h>

#include "converters/base/error.h"

namespace lumen::engine::api {

namespace {

using Clock = std::chrono::steady_clock;

/// Hands what it hears to the listener, one call at a time.
class HeardProgress : public Progress {
public:
  explicit HeardProgress(const lumen_engine_listener& listener) : m_listener(listener) {}

  void begin(std::string_view stage, std::size_t total) override {
    const std::lock_guard lock(m_mutex);
    m_total = total;
    m_done = 0;
    if (m_listener.stage) m_listener.stage(m_listener.user, std::string(stage).c_str());
  }
  void advance(std::size_t units) override {
    if (!m_listener.progress) return;
    const std::lock_guard lock(m_mutex);
    m_done += units;
    if (m_total > 0)
      m_listener.progress(m_listener.user, std::min(1.0, static_cast<double>(m_done) /
                                                             static_cast<double>(m_total)));
  }
  void warn(std::string_view message) override {
    const std::lock_guard lock(m_mutex);
    if (m_listener.warning) m_listener.warning(m_listener.user, std::string(message).c_str());
  }
  /// True if the listener asks for the end.
  bool isAskedToEnd() {
    const std::lock_guard lock(m_mutex);
    return m_listener.is_cancelled && m_listener.is_cancelled(m_listener.user) != 0;
  }

private:
  const lumen_engine_listener& m_listener;
  std::mutex m_mutex;  ///< guards the calls of the listener and the next two
  std::size_t m_total = 0, m_done = 0;
};

/// Asks the listener again and again, until this object goes.
class Watcher {
public:
  explicit Watcher(HeardProgress& progress) : m_progress(progress), m_thread([this] { watch(); }) {}
  ~Watcher() {
    {
      const std::lock_guard lock(m_mutex);
      m_isOver = true;
    }
    m_end.notify_one();
    m_thread.join();
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

private:
  void watch() {
    constexpr auto kBetween = std::chrono::milliseconds(50);
    std::unique_lock lock(m_mutex);
    do {
      if (m_progress.isAskedToEnd()) m_progress.cancel();
    } while (!m_end.wait_for(lock, kBetween, [this] { return m_isOver; }));
  }

  HeardProgress& m_progress;
  std::mutex m_mutex;
  std::condition_variable m_end;
  bool m_isOver = false;  ///< guarded by m_mutex
  std::thread m_thread;
};

}  // namespace

Options::Options(const lumen_engine_options* given) {
  if (!given) return;
  for (const OptionRow& row : given->table.rows())
    if (row.isGiven) m_held.table.set(row.name, row.givenValues);
}

lumen_engine_status refuse(lumen_engine_fault* fault, lumen_engine_status status,
                           std::string_view sentence) {
  if (!fault) return status;
  std::size_t size = std::min(sentence.size(), sizeof(fault->message) - 1);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  if (size < sentence.size())
    while (size > 0 && continues(sentence[size])) --size;
  std::copy_n(sentence.begin(), size, fault->message);
  fault->message[size] = '\0';
  return status;
}

lumen_engine_status refuseNull(lumen_engine_fault* fault, const char* function) {
  return refuse(fault, LUMEN_ENGINE_USAGE, std::string(function) + "() was handed a null pointer");
}

lumen_engine_status guarded(lumen_engine_fault* fault, const std::function<void()>& work) {
  if (fault) *fault = {};
  try {
    work();
    return LUMEN_ENGINE_OK;
  } catch (const Error& error) {
    return refuse(fault, static_cast<lumen_engine_status>(error.kind()), error.what());
  } catch (const std::bad_alloc&) {
    return refuse(fault, LUMEN_ENGINE_MEMORY, "the system has no more memory");
  } catch (const std::length_error&) {
    return refuse(fault, LUMEN_ENGINE_MEMORY, "an array is larger than memory");
  } catch (const std::exception& error) {
    return refuse(fault, LUMEN_ENGINE_FAILED, error.what());
  }
}

void listenTo(const lumen_engine_listener* listener, const std::function<void(Progress&)>& work) {
  const lumen_engine_listener heard = listener ? *listener : lumen_engine_listener{};
  HeardProgress progress(heard);
  std::optional<Watcher> watcher;
  if (heard.is_cancelled) watcher.emplace(progress);
  const int most = heard.threads > 0 ? heard.threads : tbb::this_task_arena::max_concurrency();
  tbb::task_arena(most).execute([&] { work(progress); });
}

}  // namespace lumen::engine::api
