// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/fitting/subdivision.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace lumen::convert::fitting {
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
  workspace.energy.freeze(blobs, active);
  placeNewBlob(kept, blobs, workspace.energy);
  minimiseFrom(problem, active, kAlone, blobs, workspace);
  const double energy = minimiseFrom(problem, 0, kTogether, blobs, workspace);
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

}  // namespace lumen::convert::fitting
