// SPDX-License-Identifier: Apache-2.0
// The fit of one node: two blobs, refined by selection and subdivision (docs/method.md, section
// 2.6; Yureidini's thesis, 4.4 and 4.5). All lengths are in the fit's frame (see energy.h).
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/fitting/model_energy.h"
#include "converters/stages/fitting/node_data.h"

namespace lumen::convert::fitting {

// The models that fits begin with (docs/method.md, section 2.6).

/// The node's own start, or two blobs half way to the ends of the points along its direction.
/// Farther out they would bulge beyond the points of an open end, where no point pulls them back.
std::vector<Blob> placeAlongVessel(const EnergyParameters& parameters, const NodeData& node);

/// A blob in every inscribed ball that is not mostly in another one's.
std::vector<Blob> placeInLumen(const EnergyParameters& parameters, std::span<const FitBall> lumen);

// Refinement of few blobs to more: selection and subdivision (docs/method.md, section 2.6;
// Yureidini's thesis, 4.5).

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

struct LocalModel {
  std::vector<Blob> blobs;   ///< at least one
  EnergyParameters weights;  ///< weights at the end of the fit
  double energy = 0;         ///< energy in these weights
  int subdivisions = 0;      ///< subdivisions tried
};

/// The model of a node. Two blobs as wide as the node if its points are too few to fit. Throws
/// Error(Cancelled).
LocalModel fitLocalModel(const LocalModelOptions& options, const NodeData& node,
                         const Progress& progress, FitWorkspace& workspace);

/// Points that a model shares with those of its neighbours.
struct SharedPoints {
  std::span<const formats::Vec3d> points;
  double weight = 0;  ///< weight of all together in E_d, in that of all points of the node
};

/// The blobs of a model of `node`, moved and resized to bring its surface closer to the seams with
/// its neighbours.
std::vector<Blob> refineLocalModel(const LocalModelOptions& options, const NodeData& node,
                                   const SharedPoints& seams, const LocalModel& model,
                                   FitWorkspace& workspace);

}  // namespace lumen::convert::fitting
