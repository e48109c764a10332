// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/jacobian_sums.h"

#include "converters/base/simd.h"

namespace lumen::convert::fitting {

namespace {

/// The widest vectors that the compilers keep in registers on every machine.
using Floats8 [[gnu::vector_size(32)]] = float;
using Doubles4 [[gnu::vector_size(32)]] = double;
using Floats4 [[gnu::vector_size(16)]] = float;

// By reference: a vector passed by value would have another calling convention on every machine.
// A copy of bytes would be made in two halves through the stack, for which the processor waits.
template <class Lanes, class Number>
[[gnu::always_inline]] inline void load(const Number* from, Lanes& value) {
  using Unaligned
      [[gnu::vector_size(sizeof(Lanes)), gnu::aligned(sizeof(Number)), gnu::may_alias]] = Number;
  value = *reinterpret_cast<const Unaligned*>(from);
}

[[gnu::always_inline]] inline double sum(const Doubles4& v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

[[gnu::always_inline]] inline void addHalves(const Floats8& v, Floats4& sum) {
  sum = __builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7);
}

/// Sums of four vectors, each in the order ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
[[gnu::always_inline]] inline void sumEach(const Floats8 (&v)[4], float* sums) {
  Floats4 h[4];
  for (std::size_t i = 0; i < 4; ++i) addHalves(v[i], h[i]);
  const Floats4 first = __builtin_shufflevector(h[0], h[1], 0, 4, 1, 5) +
                        __builtin_shufflevector(h[0], h[1], 2, 6, 3, 7);
  const Floats4 second = __builtin_shufflevector(h[2], h[3], 0, 4, 1, 5) +
                         __builtin_shufflevector(h[2], h[3], 2, 6, 3, 7);
  const Floats4 all = __builtin_shufflevector(first, second, 0, 1, 4, 5) +
                      __builtin_shufflevector(first, second, 2, 3, 6, 7);
  for (std::size_t i = 0; i < 4; ++i) sums[i] = all[i];
}

/// Dot products of right[0] and right[1] with the columns left[0 .. 3].
[[gnu::always_inline]] inline void tile(const float* left, const float* right, std::size_t stride,
                                        std::size_t rows, float (&out)[2][4]) {
  Floats8 total[2][4] = {};
  for (std::size_t k = 0; k < rows; k += 8) {
    Floats8 a[4], b[2];
    for (std::size_t i = 0; i < 4; ++i) load(left + i * stride + k, a[i]);
    for (std::size_t j = 0; j < 2; ++j) load(right + j * stride + k, b[j]);
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t i = 0; i < 4; ++i) total[j][i] += a[i] * b[j];
    }
  }
  for (std::size_t j = 0; j < 2; ++j) sumEach(total[j], out[j]);
}

/// Dot products of the columns left[0 .. 3] with doubles.
[[gnu::always_inline]] inline void tile(const float* left, const double* right, std::size_t stride,
                                        std::size_t rows, double (&out)[4]) {
  Doubles4 total[4] = {}, b;
  Floats4 a;
  for (std::size_t k = 0; k < rows; k += 4) {
    load(right + k, b);
    for (std::size_t i = 0; i < 4; ++i) {
      load(left + i * stride + k, a);
      total[i] += __builtin_convertvector(a, Doubles4) * b;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) out[i] = sum(total[i]);
}

}  // namespace

LUMEN_SIMD_CLONES
void multiplyTransposed(const float* jacobian, std::size_t columnStride, std::size_t n,
                        const double* residual, std::size_t rows, double* a, double* b) {
  // columns come in fours, one group per blob: tiles of 4 x 2 keep 8 sums in registers
  float out[2][4];
  double single[4];
  for (std::size_t i = 0; i < n; i += 4) {
    const float* left = jacobian + i * columnStride;
    for (std::size_t j = i; j < n; j += 2) {
      tile(left, jacobian + j * columnStride, columnStride, rows, out);
      for (std::size_t p = 0; p < 4; ++p) {
        for (std::size_t q = 0; q < 2; ++q) a[(i + p) * n + j + q] += double{out[q][p]};
      }
    }
    tile(left, residual, columnStride, rows, single);
    for (std::size_t p = 0; p < 4; ++p) b[i + p] += single[p];
  }
}

LUMEN_SIMD_CLONES
void sumColumns(const float* jacobian, std::size_t columnStride, std::size_t n, std::size_t rows,
                double* sums) {
  for (std::size_t i = 0; i < n; ++i) {
    Doubles4 total = {};
    Floats4 value;
    for (std::size_t k = 0; k < rows; k += 4) {
      load(jacobian + i * columnStride + k, value);
      total += __builtin_convertvector(value, Doubles4);
    }
    sums[i] = sum(total);
  }
}

}  // namespace lumen::convert::fitting
