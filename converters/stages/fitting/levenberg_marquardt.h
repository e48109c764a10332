// SPDX-License-Identifier: Apache-2.0
// Levenberg-Marquardt on the residuals of the fit's energy (docs/method.md, section 2.5).
//
// Not Ceres, nor Eigen's factorisations: steps are bounded by the blobs' widths and projected into
// the lumen, the normal equations come from the energy without its Jacobian ever being a matrix of
// theirs, the unknowns are a dozen or two, and the result must have the same bits on every machine,
// with and without wide vectors, which neither of them promises.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "converters/stages/fitting/energy.h"

namespace lumen::convert::fitting {

/// A ball in the fit's frame.
struct FitBall {
  formats::Vec3d centre;
  double radius = 0;
};

struct MinimiseOptions {
  int maxIterations = 50;
  /// Stops when a step lowers the energy by less than this share of it.
  double tolerance = 1e-4;
  /// No centre moves farther from the origin.
  double reach = std::numeric_limits<double>::infinity();
  /// No centre moves out of the union of these balls, if there are any.
  std::span<const FitBall> lumen = {};
};

struct MinimiseResult {
  double energy = 0;
  int iterations = 0;  ///< evaluations of the energy
};

/// The wall of the lumen or of the reach that one centre has come to: along `normal` it moves by
/// `distance`.
struct Wall {
  std::size_t unknown = 0;  ///< index of the centre's x
  std::array<double, 3> normal{};
  double distance = 0;
};

/// Buffers of minimise(), of no meaning between calls. One per thread.
struct MinimiseWorkspace {
  std::vector<double> a, b;  ///< normal equations
  std::vector<double> factor, right, step;
  std::vector<Blob> trial;
  std::vector<Wall> walls;
};

/// Lowers the energy by moving and resizing blobs[active ..], after energy.freeze(blobs, active).
/// Never ends at a higher energy than it began with. Widths stay positive. Afterwards the field of
/// `energy` is that of the final blobs. `trace`, if given, receives the energy at the start and
/// after every accepted step.
MinimiseResult minimise(Energy& energy, std::span<Blob> blobs, std::size_t active,
                        const MinimiseOptions& options, MinimiseWorkspace& workspace,
                        std::vector<double>* trace = nullptr);

/// Solves A x = -b by Cholesky's decomposition; A is n x n row-major, its upper triangle is read
/// and overwritten. False if A is not positive definite.
bool solveSymmetric(std::span<double> a, std::span<const double> b, std::size_t n,
                    std::span<double> x);

}  // namespace lumen::convert::fitting
