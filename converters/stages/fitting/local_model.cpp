// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/local_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "converters/base/statistics.h"

namespace lumen::convert::fitting {

namespace {

/// Stragglers: one point in this many, at either end of the vessel, is beyond the cover of the
/// first blobs.
constexpr std::size_t kStragglers = 20;
/// Least distance of an end from the middle, in radii. Points in one ring have no ends.
constexpr double kLeastHalf = 0.5;
/// Least distance of the balls that the second trial begins with, in radii of the wider one.
constexpr double kBallsApart = 0.8;

/// The width of two equal blobs that have that radius when both are in one place.
double widthOfTwo(const EnergyParameters& e, double radius) {
  return formats::widthForRadius(e.kernel, e.kernelParameter, radius, e.isoLevel, 2);
}

/// The ends of the points along the node's direction; a radius to either side if they are too few.
std::pair<double, double> endsAlong(const NodeData& node) {
  if (node.points.size() < kFewestPoints) return {-node.radius, node.radius};
  const formats::Vec3d& direction = node.direction;
  std::vector<double> along;
  along.reserve(node.points.size());
  for (const formats::Vec3d& p : node.points)
    along.push_back(p.x * direction.x + p.y * direction.y + p.z * direction.z);
  const std::size_t tail = along.size() / kStragglers;
  const double low = valueAtRank(along, tail), high = valueAtRank(along, along.size() - 1 - tail);
  const double middle = 0.5 * (low + high), least = kLeastHalf * node.radius;
  return {std::min(low, middle - least), std::max(high, middle + least)};
}

}  // namespace

std::vector<Blob> placeAlongVessel(const EnergyParameters& parameters, const NodeData& node) {
  if (!node.start.empty()) return {node.start.begin(), node.start.end()};
  const formats::Vec3d& direction = node.direction;
  const auto [low, high] = endsAlong(node);
  const double width = widthOfTwo(parameters, node.radius);
  std::vector<Blob> blobs;
  // quarter and three quarters of the distance from one end to the other
  for (const double along : {0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high})
    blobs.push_back({along * direction.x, along * direction.y, along * direction.z, width});
  return blobs;
}

std::vector<Blob> placeInLumen(const EnergyParameters& parameters, std::span<const FitBall> lumen) {
  std::vector<Blob> blobs;
  std::vector<const FitBall*> kept;
  for (const FitBall& ball : lumen) {
    const auto isNear = [&](const FitBall* other) {
      const double dx = ball.centre.x - other->centre.x, dy = ball.centre.y - other->centre.y;
      const double dz = ball.centre.z - other->centre.z;
      const double apart = kBallsApart * std::max(ball.radius, other->radius);
      return dx * dx + dy * dy + dz * dz < apart * apart;
    };
    if (std::any_of(kept.begin(), kept.end(), isNear)) continue;
    kept.push_back(&ball);
    blobs.push_back(
        {ball.centre.x, ball.centre.y, ball.centre.z, widthOfTwo(parameters, ball.radius)});
  }
  return blobs;
}

namespace {

/// Unknowns of a blob, which the Bayesian information criterion charges for one more.
constexpr double kUnknownsPerBlob = 4;
/// Share of the cost of a blob that it must gain while a point is farther than the accuracy asked
/// for.
constexpr double kShareWhenFar = 0.25;
/// Subdivisions in vain, in one fit, before it stops.
constexpr std::size_t kMostRefusals = 10;
/// Displacement of a new blob towards the farthest point, in old widths (Yureidini's thesis, 4.5).
constexpr double kDisplacement = 0.1;
/// Trial positions of a new blob, and their spacing in displacements.
constexpr int kTrialPlaces = 12;
constexpr double kTrialStride = 2.5;
constexpr MinimiseOptions kAlone{20, 1e-3};
constexpr MinimiseOptions kTogether{10, 1e-2};
/// A step on all points, after those on the samples.
constexpr MinimiseOptions kDecide{2, 1e-2};

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Taubin's first-order distance to the surface, from f and |grad f|^2; infinite where f is flat.
double taubinDistance(double level, double f, double gradient2) {
  return gradient2 > 0 ? std::abs(level - f) / std::sqrt(gradient2) : kInfinity;
}

double distance(const Blob& blob, const formats::Vec3d& p) {
  const double dx = p.x - blob.x, dy = p.y - blob.y, dz = p.z - blob.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

/// The point farthest from the surface, by the energy's last evaluation, that was not refused; -1
/// for its distance if all were.
std::pair<std::size_t, double> findFarthestPoint(const Energy& energy,
                                                 std::span<const std::size_t> refused) {
  std::pair<std::size_t, double> farthest{0, -1};
  const auto f = energy.field(), g2 = energy.gradientSquared();
  for (std::size_t k = 0; k < f.size(); ++k) {
    if (std::find(refused.begin(), refused.end(), k) != refused.end()) continue;
    const double d = taubinDistance(energy.parameters().isoLevel, f[k], g2[k]);
    if (d > farthest.second) farthest = {k, d};
  }
  return farthest;
}

/// The blob whose own surface is nearest to a point.
std::size_t findNearestBlob(const EnergyParameters& e, std::span<const Blob> blobs,
                            const formats::Vec3d& point) {
  std::size_t nearest = 0;
  double best = kInfinity, bestCentre = kInfinity;
  for (std::size_t j = 0; j < blobs.size(); ++j) {
    const Blob& blob = blobs[j];
    const double away = distance(blob, point), r = away / blob.width;
    const auto phi = formats::evaluateKernel(e.kernel, e.kernelParameter, r * r);
    const double d = taubinDistance(e.isoLevel, blob.width * phi.phi, 4 * phi.d1 * phi.d1 * r * r);
    // equal only where no blob has a gradient, such as outside all compact kernels
    if (d < best || (d == best && away < bestCentre)) {
      nearest = j;
      best = d;
      bestCentre = away;
    }
  }
  return nearest;
}

/// Moves the new blob, the last, along its displacement from `kept` to where the energy is least:
/// the cohesion of two blobs in nearly one place is so steep that its gradient hides all others.
void placeNewBlob(const Blob& kept, std::vector<Blob>& blobs, Energy& energy) {
  Blob& added = blobs.back();
  const Blob start = added;
  Blob best = start;
  double least = kInfinity;
  for (int i = 0; i < kTrialPlaces; ++i) {
    const double factor = 1.0 + kTrialStride * i;
    added = {kept.x + factor * (start.x - kept.x), kept.y + factor * (start.y - kept.y),
             kept.z + factor * (start.z - kept.z), start.width};
    const double value = energy.evaluate(blobs);
    if (!(value < least)) continue;
    least = value;
    best = added;
  }
  added = best;
}

/// Splits the blob nearest to `target` and minimises; the energy of the new blobs.
double addBlob(const NodeProblem& problem, const formats::Vec3d& target, std::vector<Blob>& blobs,
               FitWorkspace& workspace) {
  const std::size_t parent = findNearestBlob(problem.options.energy, blobs, target);
  const auto [kept, added] = splitBlob(problem.options.energy, target, blobs[parent]);
  const std::size_t active = blobs.size();
  blobs[parent] = kept;
  blobs.push_back(added);
  workspace.energy.freeze(blobs, active, Energy::At::Samples);
  placeNewBlob(kept, blobs, workspace.energy);
  minimiseFrom(problem, active, kAlone, blobs, workspace, Energy::At::Samples);
  minimiseFrom(problem, 0, kTogether, blobs, workspace, Energy::At::Samples);
  const double energy = minimiseFrom(problem, 0, kDecide, blobs, workspace);
  return dropUseless(problem, blobs) ? workspace.energy.evaluate(blobs) : energy;
}

}  // namespace

std::pair<Blob, Blob> splitBlob(const EnergyParameters& parameters, const formats::Vec3d& point,
                                const Blob& blob) {
  const auto [kernel, s] = std::pair(parameters.kernel, parameters.kernelParameter);
  const double radius = formats::isoRadius(kernel, s, blob.width, parameters.isoLevel);
  Blob first = blob;
  first.width = radius > 0 ? formats::widthForRadius(kernel, s, radius, parameters.isoLevel, 2)
                           : 0.5 * blob.width;
  Blob second = first;
  const double away = distance(first, point), step = kDisplacement * blob.width;
  if (away > 0) {
    second.x += step * (point.x - first.x) / away;
    second.y += step * (point.y - first.y) / away;
    second.z += step * (point.z - first.z) / away;
  } else {
    second.x += step;
  }
  return {first, second};
}

bool subdivide(const NodeProblem& problem, GrowingModel& model, FitWorkspace& workspace) {
  const double accuracy = problem.options.accuracy;
  Energy& energy = workspace.energy;
  model.energy = weighPriors(problem, model.blobs, energy);
  const auto [farthest, distance] = findFarthestPoint(energy, model.refused);
  if (distance < std::min(accuracy, kRelativeAccuracy * problem.bulge)) return false;
  const auto points = static_cast<double>(energy.pointCount());
  const double cost = kUnknownsPerBlob * formats::repeatableLog(points) / points;
  const double bound = model.energy * (1.0 - (distance < accuracy ? cost : kShareWhenFar * cost));
  std::vector<Blob> more = model.blobs;
  const double reached = addBlob(problem, energy.point(farthest), more, workspace);
  ++model.subdivisions;
  if (reached < bound) {
    model.blobs = std::move(more);
    model.energy = reached;
    return true;
  }
  model.refused.push_back(farthest);
  model.energy = energy.evaluate(model.blobs);
  return distance >= std::max(accuracy, kRelativeAccuracy * problem.bulge) &&
         model.refused.size() < kMostRefusals;
}

namespace {

/// Largest mean distance of the points, in accuracies asked for or twentieths of the radius. A fit
/// beyond it is tried again from the inscribed balls: two blobs beside a much wider vessel may end
/// in neither.
constexpr double kPoorFit = 1.0 / 3.0;
/// Half of the iterations that one alone would need: the seams move with every sweep.
constexpr MinimiseOptions kRefine{5, 1e-4};

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
