// SPDX-License-Identifier: Apache-2.0
// Sums over the rows of a Jacobian, in an order that is the same on every machine. J is of floats: it
// chooses the step, while the residuals, the gradient and the energy, of doubles, choose where it
// ends.
#pragma once

#include <cstddef>

namespace lumen::convert::fitting {

/// a += J^T J (n x n row-major, upper triangle), summed in floats, and b += J^T r, in doubles, for n
/// columns of `rows` values; n is a multiple of 4, `rows` of 8.
void multiplyTransposed(const float* jacobian, std::size_t columnStride, std::size_t n,
                        const double* residual, std::size_t rows, double* a, double* b);

/// sums[i] = sum of the `rows` values of column i < n; n is a multiple of 4, `rows` of 8.
void sumColumns(const float* jacobian, std::size_t columnStride, std::size_t n, std::size_t rows,
                double* sums);

}  // namespace lumen::convert::fitting
