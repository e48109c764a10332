// SPDX-License-Identifier: Apache-2.0
// Access to the strided columns of blob_columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "blob.h"

namespace lumen::blob {

/// Element `index` of a column whose elements are `stride` bytes apart; it may be of any alignment.
template <class T>
inline T* column(T* first, std::size_t index, std::ptrdiff_t stride) {
  using Byte = std::conditional_t<std::is_const_v<T>, const char, char>;
  return reinterpret_cast<T*>(reinterpret_cast<Byte*>(first) +
                              static_cast<std::ptrdiff_t>(index) * stride);
}

template <class T, class V>
inline void put(T* first, std::size_t index, std::ptrdiff_t stride, V value) {
  const T converted = static_cast<T>(value);
  std::memcpy(column(first, index, stride), &converted, sizeof converted);
}

/// Writes a sample's answers, but not its cursor, to the columns that are wanted.
inline void putSample(const blob_columns& c, std::size_t i, const blob_sample& sample) {
  if (c.value != nullptr) put(c.value, i, c.answer_stride, sample.value);
  if (c.distance != nullptr) put(c.distance, i, c.answer_stride, sample.distance);
  if (c.normal[0] != nullptr)
    for (int k = 0; k < 3; ++k) put(c.normal[k], i, c.answer_stride, sample.normal[k]);
  if (c.gradient[0] != nullptr)
    for (int k = 0; k < 3; ++k) put(c.gradient[k], i, c.answer_stride, sample.gradient[k]);
  if (c.state != nullptr) put(c.state, i, c.state_stride, sample.state);
}

/// Whether points are packed, so that four doubles at a time can be copied, except for the last
/// point, after which the memory may end.
inline bool arePacked(const blob_columns& c) {
  return c.point_stride == 3 * sizeof(double) && c.point[1] == c.point[0] + 1 &&
         c.point[2] == c.point[0] + 2;
}

/// Columns of packed points, without answers.
inline blob_columns packedColumns(std::size_t count, const double (*points)[3],
                                  std::uint32_t* cursors) noexcept {
  blob_columns columns = blob_columns_default();
  columns.count = count;
  for (int i = 0; i < 3; ++i) columns.point[i] = &points[0][i];
  columns.point_stride = 3 * sizeof(double);
  columns.cursor = cursors;
  return columns;
}

}  // namespace lumen::blob
