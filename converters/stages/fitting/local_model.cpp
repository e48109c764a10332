// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/local_model.h"

#include <algorithm>
#include <utility>

#include "converters/stages/fitting/starting_blobs.h"
#include "converters/stages/fitting/subdivision.h"

namespace lumen::convert::fitting {
namespace {

/// Largest mean distance of the points, in accuracies asked for or twentieths of the radius. A fit
/// beyond it is tried again from the inscribed balls: two blobs beside a much wider vessel may end
/// in neither.
constexpr double kPoorFit = 1.0 / 3.0;
constexpr MinimiseOptions kRefine{10, 1e-4};

/// Fits `blobs` to the points, adding more while they help.
LocalModel growModel(const NodeProblem& problem, std::span<const formats::Vec3d> points,
                     std::vector<Blob> blobs, const Progress& progress, FitWorkspace& workspace) {
  GrowingModel model{std::move(blobs)};
  beginEnergy(problem, points, model.blobs, workspace.energy);
  minimiseAll(problem, model.blobs, workspace);
  while (model.subdivisions < problem.options.maxSubdivisions &&
         subdivide(problem, model, workspace))
    progress.check();
  model.energy = weighPriors(problem, model.blobs, workspace.energy);
  if (model.subdivisions > 0) model.energy = minimiseAll(problem, model.blobs, workspace);
  return {std::move(model.blobs), workspace.energy.parameters(), model.energy, model.subdivisions};
}

}  // namespace

LocalModel fitLocalModel(const LocalModelOptions& options, const NodeData& node,
                         const Progress& progress, FitWorkspace& workspace) {
  std::vector<Blob> start = placeAlongVessel(options.energy, node);
  if (node.points.size() < kFewestPoints) return {std::move(start), options.energy};
  const NodeProblem problem = makeProblem(options, node, workspace.around);
  LocalModel first = growModel(problem, node.points, std::move(start), progress, workspace);
  const double distance = meanDistance(workspace.energy);
  const double coarser = std::max(options.accuracy, kRelativeAccuracy * problem.bulge);
  if (node.lumen.empty() || distance < kPoorFit * coarser) return first;
  LocalModel second = growModel(problem, node.points, placeInLumen(options.energy, node.lumen),
                                progress, workspace);
  return meanDistance(workspace.energy) < distance ? second : first;
}

std::vector<Blob> refineLocalModel(const LocalModelOptions& options, const NodeData& node,
                                   const SharedPoints& seams, const LocalModel& model,
                                   FitWorkspace& workspace) {
  std::vector<Blob> blobs = model.blobs;
  if (node.points.size() < kFewestPoints) return blobs;
  const NodeProblem problem = makeProblem(options, node, workspace.around);
  workspace.energy.setParameters(model.weights);
  workspace.energy.setPoints(node.points, seams.points, seams.weight);
  minimiseFrom(problem, 0, kRefine, blobs, workspace);
  return blobs;
}

}  // namespace lumen::convert::fitting
