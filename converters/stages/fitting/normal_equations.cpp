// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/normal_equations.h"

#include "converters/base/simd.h"

namespace lumen::convert::fitting {
namespace {

/// Half of the lanes: the widest vector that the compilers keep in registers on every machine.
using Lanes4 [[gnu::vector_size(32)]] = double;

// By reference: a vector passed by value would have another calling convention on every machine.
// A copy of bytes would be made in two halves through the stack, for which the processor waits.
[[gnu::always_inline]] inline void load(const double* from, Lanes4& value) {
  using Unaligned [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
  value = *reinterpret_cast<const Unaligned*>(from);
}

[[gnu::always_inline]] inline double sum(const Lanes4& v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

/// Dot products of the columns left[0 .. kLeft - 1] with right[0 .. kRight - 1].
template <std::size_t kLeft, std::size_t kRight>
[[gnu::always_inline]] inline void tile(const double* left, const double* right, std::size_t stride,
                                        std::size_t rows, double (&out)[kLeft][kRight]) {
  Lanes4 total[kLeft][kRight] = {};
  for (std::size_t k = 0; k < rows; k += 4) {
    Lanes4 a[kLeft], b[kRight];
    for (std::size_t i = 0; i < kLeft; ++i) load(left + i * stride + k, a[i]);
    for (std::size_t j = 0; j < kRight; ++j) load(right + j * stride + k, b[j]);
    for (std::size_t i = 0; i < kLeft; ++i) {
      for (std::size_t j = 0; j < kRight; ++j) total[i][j] += a[i] * b[j];
    }
  }
  for (std::size_t i = 0; i < kLeft; ++i) {
    for (std::size_t j = 0; j < kRight; ++j) out[i][j] = sum(total[i][j]);
  }
}

}  // namespace

LUMEN_SIMD_CLONES
void multiplyTransposed(const double* jacobian, std::size_t columnStride, std::size_t n,
                        const double* residual, std::size_t rows, double* a, double* b) {
  // columns come in fours, one group per blob: tiles of 4 x 2 keep 8 sums in registers
  double out[4][2];
  double single[4][1];
  for (std::size_t i = 0; i < n; i += 4) {
    const double* left = jacobian + i * columnStride;
    for (std::size_t j = i; j < n; j += 2) {
      tile<4, 2>(left, jacobian + j * columnStride, columnStride, rows, out);
      for (std::size_t p = 0; p < 4; ++p) {
        for (std::size_t q = 0; q < 2; ++q) a[(i + p) * n + j + q] += out[p][q];
      }
    }
    tile<4, 1>(left, residual, columnStride, rows, single);
    for (std::size_t p = 0; p < 4; ++p) b[i + p] += single[p][0];
  }
}

LUMEN_SIMD_CLONES
void sumColumns(const double* jacobian, std::size_t columnStride, std::size_t n, std::size_t rows,
                double* sums) {
  for (std::size_t i = 0; i < n; i += 4) {
    Lanes4 total[4] = {}, value;
    for (std::size_t k = 0; k < rows; k += 4) {
      for (std::size_t p = 0; p < 4; ++p) {
        load(jacobian + (i + p) * columnStride + k, value);
        total[p] += value;
      }
    }
    for (std::size_t p = 0; p < 4; ++p) sums[i + p] = sum(total[p]);
  }
}

}  // namespace lumen::convert::fitting
