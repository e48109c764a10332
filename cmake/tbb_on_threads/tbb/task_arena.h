// SPDX-License-Identifier: Apache-2.0
// See parallel_for.h.
#pragma once

#include <algorithm>

#include <tbb/global_control.h>

namespace tbb {

/// Work on a given number of threads at most; on fewer where the machine has fewer.
class task_arena {
public:
  explicit task_arena(int threads)
      : m_threads(threads > 1 ? static_cast<std::size_t>(threads) : 1) {}

  template <class Work>
  void execute(const Work& work) {
    using Control = global_control;
    const Control limit(
        Control::max_allowed_parallelism,
        std::min(m_threads, Control::active_value(Control::max_allowed_parallelism)));
    work();
  }

private:
  std::size_t m_threads;
};

namespace this_task_arena {

inline int max_concurrency() {
  return static_cast<int>(global_control::active_value(global_control::max_allowed_parallelism));
}

}  // namespace this_task_arena
}  // namespace tbb
