// SPDX-License-Identifier: Apache-2.0
// Functions of TBB that the project uses, on std::thread: for WebAssembly, where TBB's library is not, and for ThreadSanitizer,
// which cannot see how that library, built without it, hands work from thread to thread, and reports each as a race.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/partitioner.h>

namespace tbb {

/// body(i) for every i from `first` to before `last`, on as many threads as global_control allows, at most 4.
/// Throws what a body threw first, after all threads have ended.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  const std::size_t threads = global_control::active_value(global_control::max_allowed_parallelism);
  if (threads <= 1) {
    for (Index i = first; i < last; ++i) body(i);
    return;
  }
  std::atomic<Index> next{first};
  std::atomic<bool> stop{false};
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (Index i = next++; i < last && !stop; i = next++) body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!stop.exchange(true)) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (std::size_t t = 1; t < std::min<std::size_t>(threads, 4); ++t) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (thrown) std::rethrow_exception(thrown);
}

/// Ignores the partitioner, as indices are handed out one by one in any case.
template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body, simple_partitioner) {
  parallel_for(first, last, body);
}

}  // namespace tbb
