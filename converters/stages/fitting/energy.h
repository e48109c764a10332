// SPDX-License-Identifier: Apache-2.0
// The energy of a local implicit model as a sum of squares, with its analytic Jacobian
// (docs/method.md, section 2.3; Yureidini's thesis, 4.3 and appendix B).
//
// clang-format off
//   E       = E_d + alpha E_LJ + beta E_kappa + omega E_w
//
//   E_d     = 1/Np sum_k u(P_k)^2 * S / (1/Np sum_k |grad u(P_k)|^2)
//   E_LJ    = 2/(Nb (Nb - 1)) sum_{i < j} (sigma_ij^3 - 1)^2
//   E_kappa = 1/Np sum_k (kappa(P_k) - kappa_0)^2
//   E_w     = sum_j (w_j / w - 1)^2
//
//   sigma_ij = s^2 w_i w_j / |C_i - C_j|^2
//   kappa    = (G^T H G - |G|^2 tr H) / (2 |G|^3)
// clang-format on
//
// E_LJ of the thesis is 1/(Nb (Nb - 1)) sum_{i != j} sigma_ij^3 (sigma_ij^3 - 2). Because
// a (a - 2) = (a - 1)^2 - 1, the one above is that plus 1 (when Nb > 1), and E is a sum of squares.
//
// u is T - f, as in the thesis, for kernels that do not end like a power of the distance. For
// Cauchy's, which does, u = 4 T ((T / f)^(1/4) - 1), which is the same to first order at the
// surface. Far from a Cauchy blob f falls with the fourth power of the distance, so that u is
// nearly a multiple of the distance to the wall on both of its sides, where T - f grows inward and
// levels off outward: noise would move the surface.
//
// The last factor of E_d is not in the thesis. Without it the plain squares have a useless minimum
// below every good one: f = T and flat at all points, made by a few wide blobs far away, because
// noise of standard deviation q costs q^2 |grad u|^2. A minimiser that converges drifts there.
// Divided by the mean |grad u|^2 the sum is a mean squared distance (G. Taubin: Estimation of
// planar curves, surfaces, and nonplanar space curves, 1991); S is that mean for the starting
// model, where both forms agree, so that alpha and beta keep their meaning. S = 0 gives the plain
// squares.
//
// kappa_0 is 0 in the thesis. A wall that is expected to be flat swells; one that is expected to be
// evenly curved, as tubes and spheres are, only loses its bumps.
//
// E_w, not in the thesis either, favours widths of a model's blobs that hardly differ.
//
// Everything is in the fit's own frame: origin at the node, and a unit of length in which the voxel
// of the source volume measures kReferenceVoxel. The thesis' alpha, beta and s, tuned at 0.2 mm,
// then mean the same for every volume.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "formats/case/blobby.h"
#include "formats/case/case.h"

namespace lumen::convert::fitting {

// The terms of local models.

/// One term width * phi(|X - centre|^2 / width^2) of the model, in the fit's frame (see energy.h).
struct Blob {
  double x = 0, y = 0, z = 0, width = 0;
};

/// Length of a voxel in the fit's frame: the voxel that the thesis' weights were tuned at, in mm.
constexpr double kReferenceVoxel = 0.2;

struct EnergyParameters {
  formats::Kernel kernel = formats::Kernel::Cauchy;
  double kernelParameter = 0.2;
  double isoLevel = 0.1;          ///< T
  double cohesionWeight = 1e-5;   ///< alpha
  double curvatureWeight = 1e-3;  ///< beta
  double cohesionScale = 2.0;     ///< s
  double expectedCurvature = 0;   ///< kappa_0
  double referenceSlope = 0;      ///< S
  double evennessWeight = 0;      ///< omega
  double evenWidth = 1;           ///< w
};

/// Curvature and slope are evaluated at one point in this many. A model of a few blobs is smooth: the
/// curvature between samples follows from that at them.
constexpr std::size_t kSampleStride = 4;
/// Least number of such points, if there are as many: four for each unknown of a usual model.
constexpr std::size_t kFewestSamples = 64;

/// The terms, unweighted; each is zero where its weight is, but for the evenness.
struct EnergyTerms {
  double data = 0, cohesion = 0, curvature = 0, evenness = 0;
};

/// Evaluates the energy of models over one point set. Its buffers only grow, so that an object that
/// is kept per thread stops allocating after the first few nodes. Not thread-safe.
class Energy {
public:
  enum class At { AllPoints, Samples };

  explicit Energy(const EnergyParameters& parameters) : m_parameters(parameters) {}

  [[nodiscard]] const EnergyParameters& parameters() const { return m_parameters; }
  void setParameters(const EnergyParameters& parameters) { m_parameters = parameters; }
  /// The points to fit, in the fit's frame; there must be at least one. Those of `seams` count in
  /// E_d only, all together as much as `seamWeight` times all points; pointCount(), slope() and the
  /// field leave them out. The curvature and the mean slope are those of every kSampleStride-th
  /// point, or of more if that are fewer than kFewestSamples; these come first in the order of
  /// point() and of the field.
  void setPoints(std::span<const formats::Vec3d> points, std::span<const formats::Vec3d> seams = {},
                 double seamWeight = 0);
  [[nodiscard]] std::size_t pointCount() const { return m_count; }
  [[nodiscard]] formats::Vec3d point(std::size_t k) const;

  /// Sums the field of blobs[0] .. blobs[active - 1] once; until the next call they must stay as
  /// they are. evaluate() and linearise() then only visit the others, which are the unknowns, at
  /// all points or at the sampled ones only, which then stand for all.
  void freeze(std::span<const Blob> blobs, std::size_t active, At at = At::AllPoints);

  /// The energy of all of `blobs`; fills the residuals and the field at every point.
  double evaluate(std::span<const Blob> blobs);
  /// The energy of all of `blobs`, as evaluate() has it; fills the residuals, the field at every
  /// point, and the Jacobian with respect to (x, y, z, width) of every unknown blob.
  double linearise(std::span<const Blob> blobs);

  // Results of the last call of evaluate() or linearise().

  [[nodiscard]] EnergyTerms terms() const { return m_terms; }
  /// Mean |grad u|^2 over the points.
  [[nodiscard]] double slope() const { return m_slope; }
  /// Mean kappa over the points; kappa_0 if beta is 0.
  [[nodiscard]] double meanCurvature() const;
  /// f and |grad f|^2 at every point.
  [[nodiscard]] std::span<const double> field() const { return {m_field.data(), m_count}; }
  [[nodiscard]] std::span<const double> gradientSquared() const {
    return {m_gradient2.data(), m_count};
  }

  /// The normal equations after linearise(blobs): A = J^T J (row-major, only the upper triangle, 4n
  /// x 4n for n unknown blobs) and b = J^T r, half the gradient of the energy.
  void normalEquations(std::span<const Blob> blobs, std::span<double> a, std::span<double> b);

private:
  double run(std::span<const Blob> blobs, bool withJacobian);
  double sumTerms(std::span<const Blob> blobs);
  [[nodiscard]] double meanSlope() const;
  /// Rows of one column of the Jacobian: those of the data, the curvature and the slope.
  [[nodiscard]] std::size_t columnRows() const { return m_padded + 2 * m_samples; }
  /// Factor from the plain sum of the data's squares to E_d.
  [[nodiscard]] double dataFactor() const;
  void normaliseData(std::size_t n, std::span<double> a, std::span<double> b);
  void addEvenness(std::span<const Blob> blobs, std::span<double> a, std::span<double> b) const;
  void addCohesion(std::span<const Blob> blobs, std::span<double> a, std::span<double> b) const;

  EnergyParameters m_parameters;
  std::size_t m_count = 0;    ///< points
  std::size_t m_padded = 0;   ///< rounded up to whole lanes; the padding has weight zero
  std::size_t m_samples = 0;  ///< points of the curvature and the slope, in whole lanes
  std::size_t m_rows = 0;     ///< points at work: m_padded or m_samples
  std::size_t m_active = 0;   ///< first unknown blob
  EnergyTerms m_terms;
  double m_slope = 0;
  std::vector<double> m_slopeGradient;
  std::vector<double> m_x, m_y, m_z, m_weight, m_share;
  std::array<std::vector<double>, 10>
      m_frozen;  ///< f, G (3), Gamma (xx, yy, zz, xy, xz, yz) of the frozen blobs
  std::vector<double> m_field, m_gradient2, m_slope2;
  std::vector<double> m_residual;  ///< m_padded data rows, then m_samples curvature rows
  std::vector<float> m_jacobian;   ///< columnRows() for every unknown
  std::vector<double> m_scratch;
};

/// sigma^3 - 1 for one pair of blobs, and its gradient with respect to the first one's x, y, z and
/// width, then the second one's.
struct CohesionResidual {
  double value = 0;
  std::array<double, 8> gradient{};
};
CohesionResidual cohesionResidual(const Blob& first, const Blob& second, double scale);

}  // namespace lumen::convert::fitting
