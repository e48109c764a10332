// SPDX-License-Identifier: Apache-2.0
#include "converters/api/handle.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <tbb/task_arena.h>

#include "converters/api/options.h"
#include "converters/base/error.h"

namespace lumen::engine::api {

namespace {

using Clock = std::chrono::steady_clock;

/// Hands what it hears to the listener, one call at a time.
class HeardProgress : public Progress {
public:
  explicit HeardProgress(const lumen_engine_listener& listener) : m_listener(listener) {}

  void begin(std::string_view stage, std::size_t total) override {
    if (m_asksItself) ask();
    const std::lock_guard lock(m_mutex);
    m_total = total;
    m_done = 0;
    if (m_listener.stage) m_listener.stage(m_listener.user, std::string(stage).c_str());
  }
  void advance(std::size_t units) override {
    if (m_asksItself) ask();
    if (!m_listener.progress) return;
    const std::lock_guard lock(m_mutex);
    m_done += units;
    if (m_total > 0)
      m_listener.progress(m_listener.user, std::min(1.0, static_cast<double>(m_done) /
                                                             static_cast<double>(m_total)));
  }
  void warn(std::string_view message) override {
    const std::lock_guard lock(m_mutex);
    if (m_listener.warning) m_listener.warning(m_listener.user, inWordsOfC(message).c_str());
  }
  /// Cancels the work if the listener asks for the end.
  void ask() {
    const std::lock_guard lock(m_mutex);
    if (m_listener.is_cancelled && m_listener.is_cancelled(m_listener.user) != 0) cancel();
  }
  /// Lets the work ask as it advances, because no thread does.
  void askWhileWorking() { m_asksItself = true; }

private:
  const lumen_engine_listener& m_listener;
  std::mutex m_mutex;  ///< guards the calls of the listener and the next two
  std::size_t m_total = 0, m_done = 0;
  bool m_asksItself = false;
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
      m_progress.ask();
    } while (!m_end.wait_for(lock, kBetween, [this] { return m_isOver; }));
  }

  HeardProgress& m_progress;
  std::mutex m_mutex;
  std::condition_variable m_end;
  bool m_isOver = false;  ///< guarded by m_mutex
  std::thread m_thread;
};

/// Fills *fault, if there is one, and returns `status`.
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

/// Does the work; its errors get the words of this interface.
void inWords(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    throw Error(error.kind(), inWordsOfC(error.what()));
  }
}

}  // namespace

void requireGiven(const char* function, std::initializer_list<Argument> arguments) {
  for (const Argument& argument : arguments)
    if (argument.value == nullptr)
      throw Error(ErrorKind::Usage,
                  std::string(function) + "(): " + argument.name + " is a null pointer");
}

lumen_engine_status guarded(lumen_engine_fault* fault, const std::function<void()>& work) {
  if (fault) *fault = {};
  try {
    inWords(work);
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
  try {
    if (heard.is_cancelled) watcher.emplace(progress);
  } catch (const std::system_error&) {  // the host has no threads
    progress.askWhileWorking();
  }
  const int most = heard.threads > 0 ? heard.threads : tbb::this_task_arena::max_concurrency();
  tbb::task_arena(most).execute([&] { work(progress); });
}

}  // namespace lumen::engine::api
