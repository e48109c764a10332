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
  /// False if the data alone count at these points: then neither curvature nor slope is evaluated.
  bool isSample = true;
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
  // This block's rows of the first column of the Jacobian.
  float *dataRows = nullptr, *curvatureRows = nullptr;
  float* slopeRows = nullptr;    ///< derivatives of share^2 |grad u|^2
  std::size_t columnStride = 0;  ///< from one column to the next
  double* scratch = nullptr;     ///< blobs x kScratchArrays x kBlock
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

}  // namespace lumen::convert::fitting
