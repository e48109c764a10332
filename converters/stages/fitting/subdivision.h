// SPDX-License-Identifier: Apache-2.0
// Refinement of few blobs to more: selection and subdivision (docs/method.md, section 2.6;
// Yureidini's thesis, 4.5).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "converters/stages/fitting/model_energy.h"

namespace lumen::convert::fitting {

/// Accuracy of the fit, as a share of the radius (of the wall's finest bulges): points nearer than
/// this are fitted, however fine the accuracy asked for. Conversely, a vessel is fitted to this
/// share of its radius if that is finer than the accuracy asked for: 1.5 voxels are most of the
/// radius of the narrowest ones.
constexpr double kRelativeAccuracy = 0.05;

/// Two blobs of equal width whose union has the surface of `blob`: the first in its place, the
/// second moved by a tenth of the old width towards `point` (thesis eq. 4.26 and 4.27). A blob that
/// is too narrow to reach the level gives two of half its width.
std::pair<Blob, Blob> splitBlob(const EnergyParameters& parameters, const formats::Vec3d& point,
                                const Blob& blob);

/// A model during its subdivision.
struct GrowingModel {
  std::vector<Blob> blobs;
  double energy = 0;                   ///< energy of these blobs
  int subdivisions = 0;                ///< subdivisions tried
  std::vector<std::size_t> refused{};  ///< points that a subdivision did not help
};

/// One round of selection, subdivision and optimisation. The new blobs stay if they lower the
/// energy by more than four more unknowns lower that of noise; while the farthest point is beyond
/// the accuracy, a quarter of that is enough. False if the fit is good enough or nothing helps.
bool subdivide(const NodeProblem& problem, GrowingModel& model, FitWorkspace& workspace);

}  // namespace lumen::convert::fitting
