// SPDX-License-Identifier: Apache-2.0
// The fit of one node: two blobs, refined by selection and subdivision (docs/method.md, section
// 2.6; Yureidini's thesis, 4.4 and 4.5). All lengths are in the fit's frame (see energy.h).
#pragma once

#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/fitting/model_energy.h"

namespace lumen::convert::fitting {

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
