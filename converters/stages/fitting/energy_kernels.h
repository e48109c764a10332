// SPDX-License-Identifier: Apache-2.0
// The hot loops of the fit: the field, its derivatives and the Jacobian of the residuals at a block
// of points.
#pragma once

#include <cstddef>
#include <span>

#include "converters/stages/fitting/energy.h"
#include "formats/field/kernel.h"

namespace lumen::convert::fitting {

/// Added to |G|^2 in the denominator of kappa: the curvature of a field that is flat at a point
/// counts for nothing there instead of dividing by zero. |G| is 0.02 to 0.5 at the walls of
/// vessels.
constexpr double kFlatField = 1e-6;

/// Partial sums run in this many independent lanes, whatever the machine's vectors are, so that
/// every machine adds in the same order.
constexpr std::size_t kLanes = 8;
/// Points per block: the data of a block for ten blobs stay in the first-level cache.
constexpr std::size_t kBlock = 64;
/// Values of scratch memory per unknown blob in a block: delta (3), |delta|^2, phi', phi'', phi''',
/// G . delta.
constexpr std::size_t kScratchArrays = 8;

/// One block of points, and where its results go. All arrays have `count` entries.
struct Block {
  std::size_t count = 0;  ///< a multiple of kLanes, at most kBlock
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  const double* weight = nullptr;  ///< square root of a point's share of E_d; 0 for padding
  const double* share = nullptr;   ///< square root of its share of curvature and mean slope
  const double* frozen[10] = {};   ///< f, G (3), Gamma (6) of the blobs that are not unknowns
  double* field = nullptr;
  double* gradient2 = nullptr;
  double* slope2 = nullptr;             ///< |grad u|^2
  double* dataResidual = nullptr;       ///< weight u(f)
  double* curvatureResidual = nullptr;  ///< share sqrt(beta) (kappa - kappa_0)
  double* jacobian = nullptr;           ///< this block's rows of the first column
  std::size_t columnStride = 0;         ///< from one column to the next
  /// Offset from a point's data row of a column to its curvature row, and from there to its slope
  /// row: the derivative of share^2 |grad u|^2.
  std::size_t rowStride = 0;
  double* scratch = nullptr;  ///< blobs x kScratchArrays x kBlock
};

struct BlockParameters {
  field::Kernel kernel;
  double kernelScale;  ///< scale by field::chainScale
  double isoLevel;
  double curvatureScale;     ///< sqrt(beta)
  double expectedCurvature;  ///< kappa_0
};

/// Residuals, field and (if `withJacobian`) derivatives for the unknown blobs.
void evaluateBlock(const BlockParameters& parameters, const Block& block,
                   std::span<const Blob> blobs, bool withJacobian);

/// Adds f, G and Gamma = H - (tr H) I of `blobs` to frozen[0 .. 9].
void accumulateField(const BlockParameters& parameters, std::size_t count, const double* x,
                     const double* y, const double* z, std::span<const Blob> blobs,
                     double* const (&sums)[10]);

// Sums over the rows of a Jacobian, in an order that is the same on every machine.

/// a += J^T J (n x n row-major, upper triangle) and b += J^T r, for n columns of `rows` values; n
/// is a multiple of 4, `rows` of 4.
void multiplyTransposed(const double* jacobian, std::size_t columnStride, std::size_t n,
                        const double* residual, std::size_t rows, double* a, double* b);

/// sums[i] = sum of the `rows` values of column i < n; n is a multiple of 4, `rows` of 4.
void sumColumns(const double* jacobian, std::size_t columnStride, std::size_t n, std::size_t rows,
                double* sums);

}  // namespace lumen::convert::fitting
