// SPDX-License-Identifier: Apache-2.0
// See parallel_for.h. Limits may be nested, in one thread.
#pragma once

#include <cstddef>

#ifndef LUMEN_TBB_THREADS
#define LUMEN_TBB_THREADS 4
#endif

namespace tbb {

class global_control {
public:
  enum parameter { max_allowed_parallelism };

  global_control(parameter, std::size_t threads) : m_before(s_threads) { s_threads = threads; }
  ~global_control() { s_threads = m_before; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

  static std::size_t active_value(parameter) { return s_threads; }

private:
  static inline std::size_t s_threads = LUMEN_TBB_THREADS;
  std::size_t m_before;
};

}  // namespace tbb
