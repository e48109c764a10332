// SPDX-License-Identifier: Apache-2.0
// The weights and the minimisation of a node's model (docs/method.md, sections 2.4 and 2.5).
#pragma once

#include <span>
#include <vector>

#include "converters/stages/fitting/node_data.h"

namespace lumen::convert::fitting {

/// Constants of the fit of one node.
struct NodeProblem {
  const LocalModelOptions& options;
  double radius;                   ///< radius of the node
  double bulge;                    ///< radius of the wall's finest bulges
  double reach;                    ///< no centre moves farther from the node
  std::span<const FitBall> lumen;  ///< no centre moves out of their union
};

/// Buffers of fits, kept from one to the next, and the energy at work. One per thread.
struct FitWorkspace {
  Energy energy{EnergyParameters{}};
  MinimiseWorkspace minimiser;
  std::vector<FitBall> around;
};

/// `around` is filled where the node does not state its inside.
NodeProblem makeProblem(const LocalModelOptions& options, const NodeData& node,
                        std::vector<FitBall>& around);

/// Sets `energy` up with the node's points, in weights for its radius, so that it measures
/// distances of models like `blobs`.
void beginEnergy(const NodeProblem& problem, std::span<const formats::Vec3d> points,
                 std::span<const Blob> blobs, Energy& energy);

/// Weighs the priors by their effect against noise of the variance that E_d estimates, and expects
/// the mean curvature and width of `blobs`; returns the energy of `blobs` in the new weights.
/// Against points without noise the priors would only bend the surface away. E_d is a mean over all
/// points, and so the evenness of one blob counts as much as one of them.
double weighPriors(const NodeProblem& problem, std::span<const Blob> blobs, Energy& energy);

/// Minimises the energy over blobs[active ..], until a step gains less than noise does; returns the
/// final energy.
double minimiseFrom(const NodeProblem& problem, std::size_t active, MinimiseOptions options,
                    std::span<Blob> blobs, FitWorkspace& workspace,
                    Energy::At at = Energy::At::AllPoints);

/// Minimises over all blobs until none is dropped; returns the final energy.
double minimiseAll(const NodeProblem& problem, std::vector<Blob>& blobs, FitWorkspace& workspace);

/// Drops useless blobs: those at the end of their reach, or too narrow. True if any was dropped.
/// Keeps all if none has any use.
bool dropUseless(const NodeProblem& problem, std::vector<Blob>& blobs);

/// Root mean square of the points' distances, as E_d measured them last, in the fit's frame.
double meanDistance(const Energy& energy);

}  // namespace lumen::convert::fitting
