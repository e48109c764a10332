// SPDX-License-Identifier: Apache-2.0
// See parallel_for.h.
#pragma once

#include <map>
#include <mutex>
#include <thread>

namespace tbb {

/// One T for each thread that asks. A T outlives its thread.
template <class T>
class enumerable_thread_specific {
public:
  T& local() {
    const std::lock_guard lock(m_mutex);
    return m_values[std::this_thread::get_id()];
  }

  template <class Visit>
  void combine_each(const Visit& visit) {
    for (auto& [thread, value] : m_values) visit(value);
  }

private:
  std::mutex m_mutex;
  std::map<std::thread::id, T> m_values;
};

}  // namespace tbb
