// SPDX-License-Identifier: Apache-2.0
// Large arrays that cost nothing until they are written.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace lumen {

/// An array of fixed size whose values are zero. The system hands out zeroed pages, so that none is
/// written before a thread needs it, and many threads share that work.
template <class T>
class ZeroedArray {
  static_assert(std::is_trivial_v<T>);

public:
  /// Throws std::bad_alloc.
  explicit ZeroedArray(std::size_t size)
      : m_values(static_cast<T*>(std::calloc(size, sizeof(T)))), m_size(size) {
    if (!m_values && size > 0) throw std::bad_alloc();
    askForLargePages();
  }

  [[nodiscard]] std::size_t size() const { return m_size; }
  [[nodiscard]] T* data() { return m_values.get(); }
  [[nodiscard]] const T* data() const { return m_values.get(); }
  [[nodiscard]] T& operator[](std::size_t i) { return m_values.get()[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return m_values.get()[i]; }

private:
  /// Advice only, which a system may ignore: with small pages the system is asked 512 times as often.
  void askForLargePages() {
#if defined(__linux__)
    constexpr std::size_t kPage = std::size_t{1} << 21, kSmallPage = std::size_t{1} << 12;
    const std::size_t bytes = m_size * sizeof(T);
    if (bytes < 2 * kPage) return;
    void* first = m_values.get();
    std::size_t room = bytes;
    if (std::align(kSmallPage, kPage, first, room) != nullptr) madvise(first, room, MADV_HUGEPAGE);
#endif
  }

  struct Free {
    void operator()(T* values) const { std::free(values); }
  };
  std::unique_ptr<T[], Free> m_values;
  std::size_t m_size;
};

}  // namespace lumen
