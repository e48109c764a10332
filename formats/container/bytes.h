// SPDX-License-Identifier: Apache-2.0
// Little-endian numbers in byte sequences, on a machine of either byte order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace lumen::formats {

template <std::size_t size>
using UnsignedOfSize = std::conditional_t<
    size == 1, std::uint8_t,
    std::conditional_t<size == 2, std::uint16_t,
                       std::conditional_t<size == 4, std::uint32_t, std::uint64_t>>>;

/// The number stored at `from`, which must have sizeof(T) bytes.
template <class T>
T loadLittle(const std::byte* from) {
  static_assert(std::is_arithmetic_v<T>);
  using U = UnsignedOfSize<sizeof(T)>;
  U bits;
  std::memcpy(&bits, from, sizeof bits);
  if constexpr (std::endian::native == std::endian::big) {
    U swapped = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      swapped = static_cast<U>(swapped | static_cast<U>((bits >> (8 * i)) & 0xffu)
                                             << (8 * (sizeof(T) - 1 - i)));
    bits = swapped;
  }
  return std::bit_cast<T>(bits);
}

/// Appends `value`.
template <class T>
void appendLittle(std::vector<std::byte>& to, T value) {
  static_assert(std::is_arithmetic_v<T>);
  const auto bits = std::bit_cast<UnsignedOfSize<sizeof(T)>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    to.push_back(static_cast<std::byte>((bits >> (8 * i)) & 0xffu));
}

/// Stores `value` at `to`, which must have sizeof(T) bytes.
template <class T>
void storeLittle(std::byte* to, T value) {
  static_assert(std::is_arithmetic_v<T>);
  const auto bits = std::bit_cast<UnsignedOfSize<sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(to, &bits, sizeof bits);
  } else {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      to[i] = static_cast<std::byte>((bits >> (8 * i)) & 0xffu);
  }
}

/// Reads numbers one after another and never past the end: from the first read that does not fit,
/// every read gives zero and failed() stays true, so a caller may test once after a group of reads.
class ByteCursor {
public:
  explicit ByteCursor(std::span<const std::byte> bytes) : m_bytes(bytes) {}

  template <class T>
  T read() {
    if (m_failed || m_bytes.size() - m_position < sizeof(T)) {
      m_failed = true;
      return T{};
    }
    const T value = loadLittle<T>(m_bytes.data() + m_position);
    m_position += sizeof(T);
    return value;
  }
  std::span<const std::byte> take(std::size_t count) {
    if (m_failed || m_bytes.size() - m_position < count) {
      m_failed = true;
      return {};
    }
    const auto taken = m_bytes.subspan(m_position, count);
    m_position += count;
    return taken;
  }
  [[nodiscard]] bool failed() const { return m_failed; }
  [[nodiscard]] std::size_t position() const { return m_position; }

private:
  std::span<const std::byte> m_bytes;
  std::size_t m_position = 0;
  bool m_failed = false;
};

}  // namespace lumen::formats
