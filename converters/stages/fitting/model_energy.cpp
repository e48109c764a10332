// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/model_energy.h"

#include <algorithm>
#include <cmath>

namespace lumen::convert::fitting {
namespace {

/// Radius of the artery that the weights of Yureidini's thesis were tuned on, a carotid, in the
/// fit's frame.
constexpr double kTunedRadius = 2.0;
/// The thesis' beta, which the prior's weight replaces once the noise is known.
constexpr double kTunedCurvatureWeight = 1e-3;
/// The kernel whose widths the thesis' cohesion scale counts.
constexpr auto kTunedKernel = formats::Kernel::Cauchy;
/// Expectations of the priors: the standard deviation of the mean curvature of a wall about its
/// mean, in units of the inverse radius of its finest bulges, and of the widths of a model's blobs,
/// as a share of their mean.
constexpr double kCurvatureSpread = 0.5;
constexpr double kWidthSpread = 0.1;
/// Blobs stay within this many times the distance of the farthest point from the node: those of a
/// good model lie inside the vessel. Those that get there are dropped.
constexpr double kReachShare = 1.5;
/// Share of the reach from which a blob counts as having reached its end, for rounding.
constexpr double kAtReach = 0.999;
/// No blob is farther than this many radii of the node from all points, if nothing else is known
/// of the inside.
constexpr double kAroundPoints = 1.5;
constexpr MinimiseOptions kAll{60, 1e-4};
/// Noise lowers the energy of N points by a share of 1/N for each unknown that follows it. A step
/// that gains less than a third of this for all unknowns together decides nothing.
constexpr double kDecidesNothing = 0.3;

double farthestFromOrigin(std::span<const formats::Vec3d> points) {
  double squared = 0;
  for (const formats::Vec3d& p : points)
    squared = std::max(squared, p.x * p.x + p.y * p.y + p.z * p.z);
  return std::sqrt(squared);
}

/// The curvature term weighs distances against curvatures, mm against 1/mm: left alone, it would
/// swell and smooth narrow vessels by a share of their radius that grows as they get narrower.
/// Scaled with the fourth power of the radius the share stays that of the vessel which the weight
/// was tuned on.
EnergyParameters scaledEnergy(const NodeProblem& problem) {
  EnergyParameters parameters = problem.options.energy;
  const double relative = std::min(1.0, problem.radius / kTunedRadius);
  parameters.curvatureWeight *= relative * relative * relative * relative;
  // the width of a blob of given surface depends on the kernel: s counts widths of the thesis' one
  const auto width = [&](formats::Kernel kernel, double parameter) {
    return formats::widthForRadius(kernel, parameter, problem.radius, parameters.isoLevel, 2);
  };
  parameters.cohesionScale *= width(kTunedKernel, formats::defaultKernelParameter(kTunedKernel)) /
                              width(parameters.kernel, parameters.kernelParameter);
  return parameters;
}

}  // namespace

NodeProblem makeProblem(const LocalModelOptions& options, const NodeData& node,
                        std::vector<FitBall>& around) {
  const double reach = std::min(options.maxDistance, kReachShare * farthestFromOrigin(node.points));
  const double bulge = node.bulges * node.radius;
  if (!node.lumen.empty()) return {options, node.radius, bulge, reach, node.lumen};
  // at least no blob is farther from all points than the middle of the vessel is
  around.clear();
  for (const formats::Vec3d& p : node.points) around.push_back({p, kAroundPoints * node.radius});
  return {options, node.radius, bulge, reach, around};
}

void beginEnergy(const NodeProblem& problem, std::span<const formats::Vec3d> points,
                 std::span<const Blob> blobs, Energy& energy) {
  EnergyParameters parameters = scaledEnergy(problem);
  energy.setParameters(parameters);
  energy.setPoints(points);
  energy.evaluate(blobs);
  parameters.referenceSlope = energy.slope();
  energy.setParameters(parameters);
}

double weighPriors(const NodeProblem& problem, std::span<const Blob> blobs, Energy& energy) {
  EnergyParameters parameters = energy.parameters();
  const double variance = energy.terms().data;
  const double spread = problem.bulge / kCurvatureSpread;
  const double widthSpread = kWidthSpread * problem.radius / problem.bulge;
  parameters.curvatureWeight =
      problem.options.energy.curvatureWeight / kTunedCurvatureWeight * variance * spread * spread;
  parameters.expectedCurvature = energy.meanCurvature();
  double sum = 0;
  for (const Blob& blob : blobs) sum += blob.width;
  parameters.evenWidth = sum / static_cast<double>(blobs.size());
  parameters.evennessWeight =
      variance / (static_cast<double>(energy.pointCount()) * widthSpread * widthSpread);
  energy.setParameters(parameters);
  energy.freeze(blobs, 0);
  return energy.evaluate(blobs);
}

double minimiseFrom(const NodeProblem& problem, std::size_t active, MinimiseOptions options,
                    std::span<Blob> blobs, FitWorkspace& workspace, Energy::At at) {
  workspace.energy.freeze(blobs, active, at);
  options.tolerance = std::max(
      options.tolerance, kDecidesNothing / static_cast<double>(workspace.energy.pointCount()));
  options.reach = problem.reach;
  options.lumen = problem.lumen;
  return minimise(workspace.energy, blobs, active, options, workspace.minimiser).energy;
}

double minimiseAll(const NodeProblem& problem, std::vector<Blob>& blobs, FitWorkspace& workspace) {
  double energy = 0;
  do {
    energy = minimiseFrom(problem, 0, kAll, blobs, workspace);
  } while (dropUseless(problem, blobs));
  return energy;
}

bool dropUseless(const NodeProblem& problem, std::vector<Blob>& blobs) {
  const double limit = kAtReach * problem.reach;
  const auto useless = [&](const Blob& b) {
    return !(b.x * b.x + b.y * b.y + b.z * b.z <= limit * limit) ||
           !(b.width >= problem.options.minWidth);
  };
  if (std::all_of(blobs.begin(), blobs.end(), useless)) return false;
  return std::erase_if(blobs, useless) > 0;
}

double meanDistance(const Energy& energy) {
  const double reference = energy.parameters().referenceSlope;
  return reference > 0 ? std::sqrt(energy.terms().data / reference) : 0.0;
}

}  // namespace lumen::convert::fitting
