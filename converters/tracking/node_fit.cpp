// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/node_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "converters/common/statistics.h"
#include "converters/common/vectors.h"
#include "converters/tracking/icosphere.h"

namespace lumen::convert {
namespace {

/// Of a node's inliers: the share that its height holds; the rest are stragglers along the axis.
constexpr double kHeld = 0.75;
/// Of the accepting inlier rate: a cylinder below it is no vessel (Yureidini's thesis, 3.4).
constexpr double kLeastRate = 0.5;

/// Distance along the axis from the centre of `cylinder` to a candidate, mm.
double distanceAlong(const Cylinder& cylinder, const Candidates& points, std::size_t i) {
  return std::abs((points.origin + points.offset(i) - cylinder.centre).dot(cylinder.axis));
}

/// Height and wall points from the inliers of a cylinder: the smallest symmetric interval along the
/// axis that holds three quarters of them, and those in it.
TrackedNode makeNode(const Cylinder& cylinder, const Candidates& points,
                     const std::vector<std::size_t>& inliers) {
  std::vector<double> extent, strengths;
  extent.reserve(inliers.size());
  strengths.reserve(inliers.size());
  for (const std::size_t i : inliers) {
    extent.push_back(distanceAlong(cylinder, points, i));
    strengths.push_back(points.strength[i]);
  }
  TrackedNode node;
  node.meanSquareAlong = std::inner_product(extent.begin(), extent.end(), extent.begin(), 0.0) /
                         static_cast<double>(extent.size());
  node.strength = median(std::move(strengths));
  const double half = nearestRank(extent, kHeld);
  node.centre = cylinder.centre;
  node.direction = cylinder.axis;
  node.radius = cylinder.radius;
  node.inlierRate = cylinder.inlierRate;
  node.height = 2.0 * half;
  for (const std::size_t i : inliers)
    if (distanceAlong(cylinder, points, i) <= half)
      node.points.push_back(toVec3f(points.origin + points.offset(i)));
  return node;
}

/// A cylinder fixes its centre across the axis only; along it few points decide, so the centre
/// keeps within the guess' slack.
void holdPlace(const NodeGuess& guess, Cylinder& cylinder) {
  const double along = (cylinder.centre - guess.centre).dot(cylinder.axis);
  cylinder.centre += (std::clamp(along, -guess.slack, guess.slack) - along) * cylinder.axis;
}

/// Noise makes a cylinder too, but neither a good one nor one with a strong wall.
bool isNoise(const TrackContext& context, const TrackedNode& node) {
  return node.inlierRate < context.options.inlierRate &&
         node.strength < context.options.noiseMargin * context.noiseFloor;
}

}  // namespace

TrackContext::TrackContext(const BsplineVolume& theVolume, const TrackOptions& theOptions,
                           double theNoiseFloor, const Progress& theProgress)
    : volume(theVolume),
      options(theOptions),
      noiseFloor(theNoiseFloor),
      progress(theProgress),
      search(theOptions),
      rays(icosphere(icosphereOrder(theOptions.rays))) {}

TrackWorkspace::TrackWorkspace(const TrackContext& context)
    : caster(context.volume, context.rays, context.options.samples, context.options.dark) {}

double leastInlierRate(const TrackOptions& options) {
  return kLeastRate * options.inlierRate;
}

NodeFit fitNode(const TrackContext& context, const NodeGuess& guess, double minRate, Random& random,
                TrackWorkspace& workspace) {
  const VolumeGeometry& geometry = context.volume.geometry();
  Candidates& points = workspace.candidates;
  NodeFit fit;
  if (!geometry.containsWorld(guess.centre)) return fit;
  workspace.caster.cast(guess.centre, kRayRadii * guess.radius, points);
  Cylinder cylinder =
      estimateCylinder(context.search, points, {guess.direction, guess.radius, guess.smooth},
                       random, workspace.cylinder);
  fit.inlierRate = cylinder.inlierRate;
  if (cylinder.inlierRate < minRate) return fit;
  holdPlace(guess, cylinder);
  if (!geometry.containsWorld(cylinder.centre)) return fit;
  // the first rays came from a guess: cast and fit again from the better centre
  workspace.caster.cast(cylinder.centre, kRayRadii * cylinder.radius, points);
  cylinder = refineCylinder(points, cylinder, context.search.band, workspace.cylinder);
  if (cylinder.inlierRate < minRate || !geometry.containsWorld(cylinder.centre)) return fit;
  holdPlace(guess, cylinder);
  findInliers(points, cylinder, context.search.band, workspace.inliers);
  if (workspace.inliers.size() < kFewestCandidates) return fit;
  if (cylinder.axis.dot(guess.direction) < 0) cylinder.axis = -cylinder.axis;
  TrackedNode node = makeNode(cylinder, points, workspace.inliers);
  if (!isNoise(context, node)) fit.node = std::move(node);
  return fit;
}

}  // namespace lumen::convert
