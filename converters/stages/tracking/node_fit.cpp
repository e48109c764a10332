// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/node_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/cylinders/cylinder_equations.h"
#include "converters/stages/tracking/wall_review.h"

namespace lumen::convert {
namespace {

/// Share of a node's inliers that its height holds; the rest are stragglers along the axis.
constexpr double kHeldShare = 0.75;
/// Share of the accepting inlier rate below which a cylinder is no vessel (Yureidini's thesis,
/// 3.4).
constexpr double kLeastRateShare = 0.5;
/// Times that a node whose wall is not supported is fitted anew. Each time its radius falls.
constexpr int kRefits = 3;
/// Largest radius that is tried next, as a share of the last one.
constexpr double kNarrowerShare = 0.7;

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
  const double half = nearestRank(extent, kHeldShare);
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

/// The strength below which a wall cannot be distinguished from noise.
double leastStrength(const TrackContext& context) {
  return context.options.noiseMargin * context.noiseFloor;
}

/// Noise makes a cylinder too, but neither a good one nor one with a strong wall.
bool isNoise(const TrackContext& context, const TrackedNode& node) {
  return node.inlierRate < context.options.inlierRate && node.strength < leastStrength(context);
}

/// Two decimals, rounded down, so that a value below a limit never reads as if it reached it.
std::string roundedDown(double value) {
  return fixedText(std::floor(100.0 * value + 1e-9) / 100.0, 2);
}

/// Two decimals, rounded up, so that a limit never reads as if a value below it reached it.
std::string roundedUp(double value) {
  return fixedText(std::ceil(100.0 * value - 1e-9) / 100.0, 2);
}

/// Fits a node to a guess, whether or not it is lumen inside.
NodeFit fitToWall(TrackRun& run, const NodeGuess& guess, double minRate) {
  const VolumeGeometry& geometry = run.context.volume.geometry();
  Candidates& points = run.workspace.candidates;
  NodeFit fit;
  const auto stop = [&](FitStage stage, double inlierRate) {
    fit.stage = stage;
    fit.inlierRate = inlierRate;
    return std::move(fit);
  };
  const auto tooFew = [&](std::size_t walls) {
    fit.walls = walls;
    return stop(FitStage::FewWalls, 0);
  };
  if (!geometry.containsWorld(guess.centre)) return fit;
  run.workspace.caster.cast(guess.centre, kRayRadii * guess.radius, points);
  if (points.count() < kFewestCandidates) return tooFew(points.count());
  const ExpectedCylinder expected{guess.direction, guess.radius, guess.smooth};
  Cylinder cylinder =
      run.context.points == SeedPoints::Courses
          ? nearCylinder(run.context.search, points, expected, run.workspace.cylinder)
          : estimateCylinder(run.context.search, points, expected, run.random,
                             run.workspace.cylinder);
  if (cylinder.inlierRate < minRate) return stop(FitStage::LowRate, cylinder.inlierRate);
  holdPlace(guess, cylinder);
  if (!geometry.containsWorld(cylinder.centre))
    return stop(FitStage::LeftVolume, cylinder.inlierRate);
  // the first rays came from a guess: cast and fit again from the better centre
  run.workspace.caster.cast(cylinder.centre, kRayRadii * cylinder.radius, points);
  cylinder = refineCylinder(points, cylinder, run.context.search.band, run.workspace.cylinder);
  if (points.count() < kFewestCandidates) return tooFew(points.count());
  if (cylinder.inlierRate < minRate) return stop(FitStage::LowRate, cylinder.inlierRate);
  if (!geometry.containsWorld(cylinder.centre))
    return stop(FitStage::LeftVolume, cylinder.inlierRate);
  holdPlace(guess, cylinder);
  findInliers(points, cylinder, run.context.search.band, run.workspace.inliers);
  if (run.workspace.inliers.size() < kFewestCandidates) return tooFew(run.workspace.inliers.size());
  if (cylinder.axis.dot(guess.direction) < 0) cylinder.axis = -cylinder.axis;
  TrackedNode node = makeNode(cylinder, points, run.workspace.inliers);
  fit.strength = node.strength;
  if (isNoise(run.context, node)) return stop(FitStage::Noise, cylinder.inlierRate);
  fit.node = std::move(node);
  return stop(FitStage::Found, cylinder.inlierRate);
}

}  // namespace

double leastInlierRate(const TrackOptions& options) {
  return kLeastRateShare * options.inlierRate;
}

bool isNearer(const NodeFit& a, const NodeFit& b) {
  if (a.stage != b.stage) return a.stage > b.stage;
  if (a.stage == FitStage::FewWalls) return a.walls > b.walls;
  if (a.stage == FitStage::Noise) return a.strength > b.strength;
  return a.inlierRate > b.inlierRate;
}

std::string failureText(const TrackContext& context, const NodeFit& best) {
  switch (best.stage) {
    case FitStage::OutsideVolume:
      return "there is no volume: it lies outside";
    case FitStage::FewWalls:
      return "at most " + std::to_string(best.walls) +
             " rays meet the wall of a vessel, at least " + std::to_string(kFewestCandidates) +
             " are needed: does it lie in one, and are vessels bright (if not: " +
             context.options.word("dark") + ")?";
    case FitStage::LowRate:
      return "no cylinder fits: best inlier rate " + roundedDown(best.inlierRate) + ", at least " +
             roundedUp(leastInlierRate(context.options)) + " is needed (half of " +
             context.options.word("inlier-rate") + ")";
    case FitStage::DarkInside:
      return "a cylinder fits, but " + fixedText(100.0 * best.dark, 0) +
             " % of what it holds is as dark as what is around it: click in the middle of the "
             "vessel, or give its radius";
    case FitStage::LeftVolume:
      return "a cylinder fits, but its centre lies outside of the volume: a click nearer to the "
             "axis, or with a radius, would help";
    case FitStage::Noise:
      return "a cylinder fits with an inlier rate of " + roundedDown(best.inlierRate) +
             " only, and its wall is " + roundedDown(best.strength / context.noiseFloor) +
             " times as strong as noise: expected at least " +
             roundedUp(context.options.noiseMargin) + " times (" +
             context.options.word("noise-margin") + ")";
    case FitStage::Found:
      break;
  }
  return "a cylinder fits";
}

namespace {

NodeFit fitToLumen(TrackRun& run, const NodeGuess& guess, double minRate) {
  NodeFit first = fitToWall(run, guess, minRate);
  if (!first.node) return first;
  WallSupport support =
      wallSupport(run.context.volume, *first.node, guess.centre, run.context.options.dark);
  if (isSupported(support)) return first;
  first.node.reset();
  first.stage = FitStage::DarkInside;
  first.dark = support.dark;
  NodeGuess next = guess;
  next.centre = support.middle;
  next.radius = support.radius;
  for (int refit = 0; refit < kRefits; ++refit) {
    NodeFit fit = fitToWall(run, next, minRate);
    if (!fit.node) {
      next.radius *= kNarrowerShare;
      continue;
    }
    support = wallSupport(run.context.volume, *fit.node, guess.centre, run.context.options.dark);
    if (isSupported(support)) return fit;
    next.centre = support.middle;
    next.radius = std::min(support.radius, kNarrowerShare * next.radius);
  }
  return first;
}

}  // namespace

NodeFit fitNode(TrackRun& run, const NodeGuess& guess, double minRate) {
  const PlaceTest& isNoVessel = run.context.isNoVessel;
  if (!isNoVessel) return fitToLumen(run, guess, minRate);
  if (isNoVessel(guess.centre)) return {};
  NodeFit fit = fitToLumen(run, guess, minRate);
  if (fit.node && isNoVessel(fit.node->centre)) return {};
  return fit;
}

}  // namespace lumen::convert
