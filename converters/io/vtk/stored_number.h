// SPDX-License-Identifier: Apache-2.0
// Binary numbers of files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace lumen::convert {

enum class Endian : bool { Little, Big };

/// The number of type T at `bytes`, at any alignment.
template <class T>
T loadNumber(const char* bytes, Endian endian) {
  static_assert(std::endian::native == std::endian::little);
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (endian == Endian::Big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace lumen::convert
