// SPDX-License-Identifier: Apache-2.0
#include "converters/fitting/local_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumen::convert::fitting {
namespace {

/// Radius of the artery that the thesis' weights were tuned on, a carotid, in the fit's frame.
constexpr double kTunedRadius = 2.0;
/// A vessel is fitted to this share of its radius if that is finer than the accuracy asked for: 1.5
/// voxels are most of the radius of the narrowest ones.
constexpr double kRelativeAccuracy = 0.05;
/// Unknowns of a blob: what one more must pay for in the Bayesian information criterion.
constexpr double kUnknownsPerBlob = 4;
/// The share of that cost which a blob must pay while a point is farther than the accuracy asked
/// for.
constexpr double kShareWhenFar = 0.25;
/// Blobs stay within this many times the distance of the farthest point from the node: those of a
/// good model lie inside the vessel. Those that get there are dropped.
constexpr double kReach = 1.5;
/// No blob is farther than this many radii of the node from all points, if nothing else is known
/// of the inside.
constexpr double kAroundPoints = 1.5;
/// A fit whose points are farther, in the mean and in accuracies asked for, is tried again from the
/// inscribed balls: two blobs beside a much wider vessel may end in neither.
constexpr double kPoorFit = 1.0 / 3.0;
/// Balls that the second trial begins with are so many radii of the wider one apart.
constexpr double kBallsApart = 0.8;
/// Subdivisions in vain, in one fit, before it stops.
constexpr std::size_t kMostRefusals = 10;
constexpr MinimiseOptions kAlone{20, 1e-3};
constexpr MinimiseOptions kTogether{10, 1e-2};
constexpr MinimiseOptions kAll{60, 1e-4};
constexpr MinimiseOptions kRefine{10, 1e-4};
/// The thesis' beta, in whose place the prior's weight comes once the noise is known.
constexpr double kTunedCurvatureWeight = 1e-3;
/// Standard deviation of the mean curvature of a wall about its mean, in units of the inverse
/// radius, and of the widths of a model's blobs, as a share of their mean: what the priors expect.
constexpr double kCurvatureSpread = 0.5;
constexpr double kWidthSpread = 0.1;
/// Trial positions of a new blob, and their spacing in tenths of the old width.
constexpr int kPartingSteps = 12;
constexpr double kPartingStride = 2.5;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Taubin's first-order distance to the surface, from f and |grad f|^2; infinite where f is flat.
double taubinDistance(double level, double f, double gradient2) {
  return gradient2 > 0 ? std::abs(level - f) / std::sqrt(gradient2) : kInfinity;
}

double distance(const Blob& blob, const formats::Vec3d& p) {
  const double dx = p.x - blob.x, dy = p.y - blob.y, dz = p.z - blob.z;
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

double farthestFromOrigin(std::span<const formats::Vec3d> points) {
  double squared = 0;
  for (const formats::Vec3d& p : points) {
    squared = std::max(squared, p.x * p.x + p.y * p.y + p.z * p.z);
  }
  return std::sqrt(squared);
}

}  // namespace

void split(const EnergyParameters& parameters, const formats::Vec3d& point, Blob& first,
           Blob& second) {
  const double width = first.width;
  const double radius =
      formats::isoRadius(parameters.kernel, parameters.kernelParameter, width, parameters.isoLevel);
  first.width = radius > 0 ? formats::widthForRadius(parameters.kernel, parameters.kernelParameter,
                                                     radius, parameters.isoLevel, 2)
                           : 0.5 * width;
  second = first;
  const double away = distance(first, point);
  const double step = 0.1 * width;
  if (away > 0) {
    second.x += step * (point.x - first.x) / away;
    second.y += step * (point.y - first.y) / away;
    second.z += step * (point.z - first.z) / away;
  } else {
    second.x += step;
  }
}

LocalModel::LocalModel(const LocalModelOptions& options)
    : m_options(options), m_energy(options.energy) {}

/// Two blobs half way to the ends of the points along the node's direction. Farther out they would
/// bulge beyond the points of an open end, where nothing calls them back.
void LocalModel::start(const NodeData& node) {
  if (!node.start.empty()) {
    m_blobs.assign(node.start.begin(), node.start.end());
    return;
  }
  const std::span<const formats::Vec3d> points = node.points;
  const formats::Vec3d& direction = node.direction;
  const double radius = node.radius;
  double low = -radius, high = radius;
  if (points.size() >= kFewestPoints) {
    m_along.clear();
    for (const formats::Vec3d& p : points) {
      m_along.push_back(p.x * direction.x + p.y * direction.y + p.z * direction.z);
    }
    const auto tail = static_cast<std::ptrdiff_t>(points.size() / 20);
    std::nth_element(m_along.begin(), m_along.begin() + tail, m_along.end());
    low = m_along[static_cast<std::size_t>(tail)];
    std::nth_element(m_along.begin(), m_along.end() - 1 - tail, m_along.end());
    high = m_along[m_along.size() - 1 - static_cast<std::size_t>(tail)];
    const double middle = 0.5 * (low + high);
    low = std::min(low, middle - 0.5 * radius);
    high = std::max(high, middle + 0.5 * radius);
  }
  const double width =
      formats::widthForRadius(m_options.energy.kernel, m_options.energy.kernelParameter, radius,
                              m_options.energy.isoLevel, 2);
  m_blobs.clear();
  // quarter and three quarters of the way from one end to the other
  for (const double along : {0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high}) {
    m_blobs.push_back({along * direction.x, along * direction.y, along * direction.z, width});
  }
}

/// A blob in every inscribed ball that is not mostly in another one's.
void LocalModel::startInLumen(const NodeData& node) {
  const EnergyParameters& e = m_options.energy;
  m_blobs.clear();
  std::vector<const Ball*> kept;
  for (const Ball& ball : node.lumen) {
    const auto isNear = [&](const Ball* other) {
      const double dx = ball.centre.x - other->centre.x, dy = ball.centre.y - other->centre.y;
      const double dz = ball.centre.z - other->centre.z;
      const double apart = kBallsApart * std::max(ball.radius, other->radius);
      return dx * dx + dy * dy + dz * dz < apart * apart;
    };
    if (std::any_of(kept.begin(), kept.end(), isNear)) continue;
    kept.push_back(&ball);
    m_blobs.push_back(
        {ball.centre.x, ball.centre.y, ball.centre.z,
         formats::widthForRadius(e.kernel, e.kernelParameter, ball.radius, e.isoLevel, 2)});
  }
}

/// The curvature term weighs distances against curvatures, mm against 1/mm: left alone, it would
/// swell and smooth narrow vessels by a share of their radius that grows as they get narrower.
/// Scaled with the fourth power of the radius the share stays that of the vessel which the weight
/// was tuned on.
EnergyParameters LocalModel::scaledEnergy() const {
  EnergyParameters parameters = m_options.energy;
  const double relative = std::min(1.0, m_radius / kTunedRadius);
  parameters.curvatureWeight *= relative * relative * relative * relative;
  // the width of a blob of given surface depends on the kernel: s counts widths of the thesis' one
  const auto width = [&](formats::Kernel kernel, double parameter) {
    return formats::widthForRadius(kernel, parameter, m_radius, parameters.isoLevel, 2);
  };
  constexpr auto kTuned = formats::Kernel::Cauchy;
  parameters.cohesionScale *= width(kTuned, formats::defaultKernelParameter(kTuned)) /
                              width(parameters.kernel, parameters.kernelParameter);
  return parameters;
}

void LocalModel::beginEnergy(std::span<const formats::Vec3d> points) {
  EnergyParameters parameters = scaledEnergy();
  m_energy.setParameters(parameters);
  m_energy.setPoints(points);
  m_energy.evaluate(m_blobs);
  parameters.referenceSlope = m_energy.slope();
  m_energy.setParameters(parameters);
}

/// Drops blobs that have no use: at the end of their reach, or too narrow. True if it did.
bool LocalModel::cleanUp() {
  const double limit = 0.999 * m_reach;
  const auto useless = [&](const Blob& b) {
    return !(b.x * b.x + b.y * b.y + b.z * b.z <= limit * limit) ||
           !(b.width >= m_options.minWidth);
  };
  if (std::all_of(m_blobs.begin(), m_blobs.end(), useless)) return false;
  return std::erase_if(m_blobs, useless) > 0;
}

void LocalModel::minimise(std::size_t active, MinimiseOptions options) {
  m_energy.freeze(m_blobs, active);
  options.reach = m_reach;
  options.lumen = m_lumen;
  m_value = m_minimiser.minimise(m_energy, m_blobs, active, options).energy;
}

void LocalModel::minimiseAll() {
  do {
    minimise(0, kAll);
  } while (cleanUp());
}

std::size_t LocalModel::farthestPoint(double& distance) const {
  std::size_t farthest = 0;
  distance = -1;
  const auto f = m_energy.field(), g2 = m_energy.gradientSquared();
  for (std::size_t k = 0; k < f.size(); ++k) {
    if (std::find(m_refused.begin(), m_refused.end(), k) != m_refused.end()) continue;
    const double d = taubinDistance(m_options.energy.isoLevel, f[k], g2[k]);
    if (!(d > distance)) continue;
    distance = d;
    farthest = k;
  }
  return farthest;
}

std::size_t LocalModel::nearestBlob(const formats::Vec3d& point) const {
  const EnergyParameters& e = m_options.energy;
  std::size_t nearest = 0;
  double best = kInfinity, bestCentre = kInfinity;
  for (std::size_t j = 0; j < m_blobs.size(); ++j) {
    const Blob& blob = m_blobs[j];
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

/// Moves the new blob, the last, along its displacement to where the energy is least: the cohesion
/// of two blobs in nearly one place is so steep that its gradient hides all others.
void LocalModel::part(const Blob& kept) {
  Blob& added = m_blobs.back();
  const Blob start = added;
  Blob best = start;
  double least = kInfinity;
  for (int i = 0; i < kPartingSteps; ++i) {
    const double factor = 1.0 + kPartingStride * i;
    added = {kept.x + factor * (start.x - kept.x), kept.y + factor * (start.y - kept.y),
             kept.z + factor * (start.z - kept.z), start.width};
    const double energy = m_energy.evaluate(m_blobs);
    if (!(energy < least)) continue;
    least = energy;
    best = added;
  }
  added = best;
}

/// The priors weigh what they do against noise of the variance that E_d estimates: against points
/// without noise they would only bend the surface away. E_d is a mean over all points, and so the
/// evenness of one blob counts as much as one of them.
void LocalModel::weighPriors() {
  EnergyParameters parameters = m_energy.parameters();
  const double variance = m_energy.terms().data;
  const double spread = m_radius / kCurvatureSpread;
  parameters.curvatureWeight =
      m_options.energy.curvatureWeight / kTunedCurvatureWeight * variance * spread * spread;
  parameters.expectedCurvature = m_energy.meanCurvature();
  double sum = 0;
  for (const Blob& blob : m_blobs) sum += blob.width;
  parameters.evenWidth = sum / static_cast<double>(m_blobs.size());
  parameters.evennessWeight =
      variance / (static_cast<double>(m_energy.pointCount()) * kWidthSpread * kWidthSpread);
  m_energy.setParameters(parameters);
  m_energy.freeze(m_blobs, 0);
  m_value = m_energy.evaluate(m_blobs);
}

/// One round of selection, subdivision and optimisation. The new model stays if it lowers the
/// energy, and if the farthest point was within the accuracy already, only if it lowers it by more
/// than four more unknowns lower that of noise. False if the fit is good enough or nothing helps.
bool LocalModel::subdivide() {
  weighPriors();
  double distance = 0;
  const std::size_t farthest = farthestPoint(distance);
  if (distance < std::min(m_options.accuracy, kRelativeAccuracy * m_radius)) return false;
  const formats::Vec3d target = m_energy.point(farthest);
  const auto points = static_cast<double>(m_energy.pointCount());
  const double cost = kUnknownsPerBlob * formats::repeatableLog(points) / points;
  const double bound =
      m_value * (1.0 - (distance < m_options.accuracy ? cost : kShareWhenFar * cost));

  m_spare = m_blobs;
  const std::size_t parent = nearestBlob(target);
  Blob added;
  split(m_options.energy, target, m_blobs[parent], added);
  m_blobs.push_back(added);
  ++m_subdivisions;
  const std::size_t active = m_blobs.size() - 1;
  m_energy.freeze(m_blobs, active);
  part(m_blobs[parent]);
  minimise(active, kAlone);
  minimise(0, kTogether);
  if (cleanUp()) m_value = m_energy.evaluate(m_blobs);
  if (m_value < bound) return true;

  m_blobs = m_spare;
  m_refused.push_back(farthest);
  m_value = m_energy.evaluate(m_blobs);
  return distance >= m_options.accuracy && m_refused.size() < kMostRefusals;
}

/// Where nothing says what is inside, at least no blob is farther from all points than the middle
/// of the vessel is.
std::span<const Ball> LocalModel::lumenOf(const NodeData& node) {
  if (!node.lumen.empty()) return node.lumen;
  m_around.clear();
  for (const formats::Vec3d& p : node.points) m_around.push_back({p, kAroundPoints * node.radius});
  return m_around;
}

/// Root mean square of the points' distances, as E_d measures them.
double LocalModel::meanDistance() const {
  const double reference = m_energy.parameters().referenceSlope;
  return reference > 0 ? std::sqrt(m_energy.terms().data / reference) : 0.0;
}

void LocalModel::grow(const NodeData& node, const Progress& progress) {
  m_subdivisions = 0;
  m_refused.clear();
  beginEnergy(node.points);
  minimiseAll();
  while (m_subdivisions < m_options.maxSubdivisions && subdivide()) progress.check();
  weighPriors();
  if (m_subdivisions > 0) minimiseAll();
}

std::span<const Blob> LocalModel::fit(const NodeData& node, const Progress& progress) {
  start(node);
  m_radius = node.radius;
  m_lumen = lumenOf(node);
  m_subdivisions = 0;
  m_value = 0;
  m_refused.clear();
  if (node.points.size() < kFewestPoints) return m_blobs;
  m_reach = std::min(m_options.maxDistance, kReach * farthestFromOrigin(node.points));
  grow(node, progress);
  const double distance = meanDistance();
  if (node.lumen.empty() || distance < kPoorFit * m_options.accuracy) return m_blobs;
  m_first = m_blobs;
  const EnergyParameters parameters = m_energy.parameters();
  const double value = m_value;
  startInLumen(node);
  grow(node, progress);
  if (meanDistance() < distance) return m_blobs;
  m_blobs = m_first;
  m_energy.setParameters(parameters);
  m_value = value;
  return m_blobs;
}

std::span<const Blob> LocalModel::refine(const NodeData& node, std::span<const formats::Vec3d> ties,
                                         std::span<const Blob> blobs, double tieShare,
                                         const EnergyParameters& parameters) {
  m_blobs.assign(blobs.begin(), blobs.end());
  if (node.points.size() < kFewestPoints) return m_blobs;
  m_radius = node.radius;
  m_lumen = lumenOf(node);
  m_reach = std::min(m_options.maxDistance, kReach * farthestFromOrigin(node.points));
  m_energy.setParameters(parameters);
  m_energy.setPoints(node.points, ties, tieShare);
  minimise(0, kRefine);
  return m_blobs;
}

}  // namespace lumen::convert::fitting
