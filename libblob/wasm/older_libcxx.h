// SPDX-License-Identifier: Apache-2.0
// What emscripten 3.1.6 in Debian 12 lacks of the C++20 library (its libc++ is 13), for forced
// inclusion.
#pragma once

#ifdef __cplusplus
#include <version>
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
#include <charconv>
#include <concepts>
#include <cstdio>

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

// Only messages print numbers, so the digits need not be the fewest.
template <floating_point T>
to_chars_result to_chars(char* first, char* last, T value) {
  const int size = snprintf(first, static_cast<size_t>(last - first), "%.9g", double(value));
  if (size < 0 || size >= last - first) return {last, errc::value_too_large};
  return {first + size, errc{}};
}

}  // namespace std
#endif
#endif
