// SPDX-License-Identifier: Apache-2.0
// Declared in grid_files.h.
#include <bit>

#include "converters/export/shared/grid_files.h"

namespace lumen::convert {

namespace {

static_assert(std::endian::native == std::endian::little, "the file has the machine's numbers");

/// The header, padded to a multiple of 64 bytes, which aligns the values.
std::string npyHeader(const std::string& type, const std::vector<std::size_t>& shape) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (";
  for (const std::size_t n : shape) text += std::to_string(n) + ", ";
  if (shape.size() > 1) text.resize(text.size() - 2);
  text += "), }";
  constexpr std::size_t kBefore = 10, kAlignment = 64;
  text.append(kAlignment - 1 - (kBefore + text.size()) % kAlignment, ' ');
  text += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(text.size() & 255U);
  bytes += static_cast<char>(text.size() >> 8U);
  return bytes + text;
}

template <class T>
std::string encodedNpy(const std::string& type, std::span<const T> values,
                       const std::vector<std::size_t>& shape) {
  std::string bytes = npyHeader(type, shape);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return bytes;
}

}  // namespace

std::string encodeNpy(std::span<const float> values, const std::vector<std::size_t>& shape) {
  return encodedNpy("<f4", values, shape);
}

std::string encodeNpy(std::span<const std::uint8_t> values, const std::vector<std::size_t>& shape) {
  return encodedNpy("|u1", values, shape);
}

std::string encodeNpy(std::span<const std::int64_t> values, const std::vector<std::size_t>& shape) {
  return encodedNpy("<i8", values, shape);
}

}  // namespace lumen::convert
