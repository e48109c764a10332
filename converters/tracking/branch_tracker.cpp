// SPDX-License-Identifier: Apache-2.0
#include "converters/tracking/branch_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include "converters/tracking/icosphere.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::StopReason;

/// Closest point to `p` on the segment a-b, as a fraction of it.
double fractionOnSegment(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
}

std::string rateText(double best, double needed) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "best inlier rate %.2f, at least %.2f is needed", best,
                needed);
  return text.data();
}

constexpr double kOnCourse = 0.77;  // cosine of 40 degrees
constexpr double kMostTurn = 0.64;  // of 50

constexpr std::size_t kNoTurn = std::numeric_limits<std::size_t>::max();

/// Where a track that has come back to itself turned round, as the number of nodes before, or
/// kNoTurn; `next` has come back if it lies in the core of an earlier node although the way to that
/// is longer than a bend of a vessel would make it.
std::size_t turningPoint(const std::vector<TrackedNode>& nodes, const TrackedNode& next) {
  const Vector3d ahead = next.centre - nodes.back().centre;
  if (ahead.dot(nodes.back().direction) <= 0) return nodes.size();
  double way = ahead.norm(), farthest = 0;
  std::size_t turn = nodes.size();
  for (std::size_t i = nodes.size() - 1; i-- > 0;) {
    way += (nodes[i + 1].centre - nodes[i].centre).norm();
    const double distance = (next.centre - nodes[i].centre).norm();
    if (distance > farthest) {
      farthest = distance;
      turn = i;
    }
    if (distance < 0.75 * nodes[i].radius && way > 1.5 * distance + nodes[i].radius) return turn;
  }
  return kNoTurn;
}

/// Where a path is heading: between its last direction and the chord over its last radius and a
/// half, which on a thin vessel are two witnesses better than one.
Vector3d courseOf(const std::vector<TrackedNode>& nodes) {
  const TrackedNode& last = nodes.back();
  for (std::size_t i = nodes.size() - 1; i-- > 0;) {
    const Vector3d chord = last.centre - nodes[i].centre;
    if (i >= 3 && chord.norm() >= 1.5 * last.radius)
      return (last.direction + chord.normalized()).normalized();
  }
  return last.direction;
}

/// Drops the last nodes if they are much wider than those before: they saw the rounded end of the
/// vessel.
void dropTip(std::vector<TrackedNode>& nodes) {
  for (int dropped = 0; dropped < 3 && nodes.size() > 8; ++dropped) {
    double radius = 0;
    for (std::size_t i = nodes.size() - 7; i + 1 < nodes.size(); ++i)
      radius += nodes[i].radius / 6.0;
    if (nodes.back().radius < 1.4 * radius) return;
    nodes.pop_back();
  }
}

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

TrackedNode reversed(TrackedNode node) {
  node.direction = -node.direction;
  return node;
}

ChainPoint closestOnChain(const std::vector<TrackedNode>& chain, const Vector3d& point) {
  ChainPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const TrackedNode& a = chain[i];
    const TrackedNode& b = chain[std::min(i + 1, chain.size() - 1)];
    const double t = fractionOnSegment(a.centre, b.centre, point);
    const Vector3d at = a.centre + t * (b.centre - a.centre);
    const double distance = (point - at).norm();
    if (distance < best.distance)
      best = {at, a.radius + t * (b.radius - a.radius), distance,
              t < 0.5 ? i : std::min(i + 1, chain.size() - 1)};
  }
  return best;
}

bool inCore(std::span<const TrackedBranch* const> branches, const Vector3d& point) {
  return std::any_of(branches.begin(), branches.end(), [&](const TrackedBranch* branch) {
    if (branch->nodes.empty()) return false;
    const ChainPoint closest = closestOnChain(branch->nodes, point);
    return closest.distance < 0.5 * closest.radius;
  });
}

BranchTracker::BranchTracker(const BsplineVolume& volume, const TrackOptions& options,
                             double noiseFloor, const Progress& progress)
    : m_volume(volume),
      m_options(options),
      m_noiseFloor(noiseFloor),
      m_progress(progress),
      m_rays(volume, icosphere(icosphereOrder(options.rays)), options.samples, options.dark),
      m_estimator(options) {}

/// Height and wall points from the candidates in m_points: the smallest symmetric interval along
/// the axis that holds 75 % of the inliers, and those in it.
void BranchTracker::finishNode(TrackedNode& node, const Cylinder& cylinder) {
  m_estimator.inliers(m_points, cylinder, m_inliers);
  std::vector<double> extent;
  extent.reserve(m_inliers.size());
  const auto along = [&](std::size_t i) {
    return std::abs((m_points.origin + m_points.offset(i) - cylinder.centre).dot(cylinder.axis));
  };
  for (const std::size_t i : m_inliers) extent.push_back(along(i));
  node.meanSquareAlong = std::inner_product(extent.begin(), extent.end(), extent.begin(), 0.0) /
                         static_cast<double>(extent.size());
  const auto held = static_cast<std::size_t>(std::ceil(0.75 * static_cast<double>(extent.size())));
  std::nth_element(extent.begin(), extent.begin() + static_cast<std::ptrdiff_t>(held - 1),
                   extent.end());
  const double half = extent[held - 1];
  std::vector<double> strengths;
  strengths.reserve(m_inliers.size());
  for (const std::size_t i : m_inliers) strengths.push_back(m_points.strength[i]);
  node.strength = median(std::move(strengths));
  node.centre = cylinder.centre;
  node.direction = cylinder.axis;
  node.radius = cylinder.radius;
  node.inlierRate = cylinder.inlierRate;
  node.height = 2.0 * half;
  node.points.clear();
  for (const std::size_t i : m_inliers) {
    if (along(i) > half) continue;
    const Eigen::Vector3f p = (m_points.origin + m_points.offset(i)).cast<float>();
    node.points.push_back({p.x(), p.y(), p.z()});
  }
}

std::optional<TrackedNode> BranchTracker::fitNode(const Guess& guess, double minRate,
                                                  Random& random) {
  const VolumeGeometry& geometry = m_volume.geometry();
  if (!geometry.containsWorld(guess.centre)) return std::nullopt;
  // a cylinder fixes its centre across the axis only: along it, few points decide, so not freely
  const auto holdPlace = [&](Cylinder& cylinder) {
    const double along = (cylinder.centre - guess.centre).dot(cylinder.axis);
    cylinder.centre += (std::clamp(along, -guess.slack, guess.slack) - along) * cylinder.axis;
  };
  m_rays.cast(guess.centre, 3.0 * guess.radius, m_points);
  Cylinder cylinder =
      m_estimator.estimate(m_points, guess.direction, guess.radius, guess.smooth, random);
  m_bestRate = std::max(m_bestRate, cylinder.inlierRate);
  if (cylinder.inlierRate < minRate) return std::nullopt;
  holdPlace(cylinder);
  if (!geometry.containsWorld(cylinder.centre)) return std::nullopt;
  // the first rays came from a guess: cast and fit again from the better centre
  m_rays.cast(cylinder.centre, 3.0 * cylinder.radius, m_points);
  cylinder = m_estimator.refine(m_points, cylinder);
  if (cylinder.inlierRate < minRate || !geometry.containsWorld(cylinder.centre))
    return std::nullopt;
  holdPlace(cylinder);
  m_estimator.inliers(m_points, cylinder, m_inliers);
  if (m_inliers.size() < 8) return std::nullopt;
  if (cylinder.axis.dot(guess.direction) < 0) cylinder.axis = -cylinder.axis;
  TrackedNode node;
  finishNode(node, cylinder);
  if (isNoise(node)) return std::nullopt;
  return node;
}

/// `steps` prediction steps ahead. Few wall points make a short height, so a step has a least
/// length.
BranchTracker::Guess BranchTracker::predict(const TrackedNode& from, double steps,
                                            const Vector3d& direction) const {
  const double step = std::max(m_options.step * from.height, 0.25 * from.radius);
  return {from.centre + steps * step * direction, direction, from.radius, true, 0.5 * step};
}

BranchTracker::Recent BranchTracker::recent(const std::vector<TrackedNode>& nodes) {
  const std::size_t count = std::min<std::size_t>(nodes.size(), 8);
  Recent mean;
  for (std::size_t i = nodes.size() - count; i < nodes.size(); ++i) {
    mean.inlierRate += nodes[i].inlierRate / static_cast<double>(count);
    mean.strength += nodes[i].strength / static_cast<double>(count);
    mean.radius += nodes[i].radius / static_cast<double>(count);
  }
  return mean;
}

/// Noise makes a cylinder too, but neither a good one nor one with a strong wall.
bool BranchTracker::isNoise(const TrackedNode& node) const {
  return node.inlierRate < m_options.inlierRate &&
         node.strength < m_options.noiseMargin * m_noiseFloor;
}

/// A poor fit that is suddenly wide is drawn around the vessel and one that touches it.
bool BranchTracker::isSwollen(const std::vector<TrackedNode>& nodes,
                              const TrackedNode& next) const {
  return next.inlierRate < m_options.inlierRate && next.radius > 1.5 * recent(nodes).radius;
}

/// How many steps, up to kTrialSteps, a track from a node that was fitted to a guess goes on.
int BranchTracker::stepsFrom(const TrackedNode& start, Random& random) {
  std::vector<TrackedNode> nodes{start};
  for (int step = 0; step < kTrialSteps; ++step) {
    auto next = fitNode(predict(nodes.back(), 1, nodes.back().direction),
                        0.5 * m_options.inlierRate, random);
    if (!next || isSwollen(nodes, *next) || turningPoint(nodes, *next) != kNoTurn) return step;
    nodes.push_back(std::move(*next));
  }
  return kTrialSteps;
}

/// Where the next step finds nothing: the nearest place ahead at which two consecutive nodes fit as
/// well as the vessel did so far; empty if there is none. Survives local drops of intensity.
std::vector<TrackedNode> BranchTracker::lookAhead(const std::vector<TrackedNode>& nodes,
                                                  Random& random) {
  const TrackedNode& last = nodes.back();
  const Recent mean = recent(nodes);
  const double minRate = std::max(0.5 * m_options.inlierRate, 0.8 * mean.inlierRate);
  const auto plausible = [&](const TrackedNode& node) {
    return node.strength >= 0.5 * mean.strength && node.radius >= 0.6 * last.radius &&
           node.radius <= 1.5 * last.radius;
  };
  // another vessel that happens to pass beyond the end of this one runs across the way to it
  const auto onCourse = [&](const TrackedNode& node) {
    const Vector3d way = node.centre - last.centre;
    return way.norm() < 2.0 * mean.radius || (way.normalized().dot(node.direction) > kOnCourse &&
                                              last.direction.dot(node.direction) > kMostTurn);
  };
  const auto [e1, e2] = planeBasis(last.direction);
  for (int steps = 1; steps <= m_options.lookAhead; ++steps)
    for (int side = 0; side <= 6; ++side) {
      m_progress.check();
      const double angle = std::numbers::pi / 3.0 * side;
      const Vector3d aside = std::cos(angle) * e1 + std::sin(angle) * e2;
      const Vector3d direction =
          side == 0 ? last.direction : Vector3d(last.direction + 0.5 * aside).normalized();
      std::optional<TrackedNode> first = fitNode(predict(last, steps, direction), minRate, random);
      if (!first || !plausible(*first) || turningPoint(nodes, *first) != kNoTurn) continue;
      std::optional<TrackedNode> second =
          fitNode(predict(*first, 1, first->direction), minRate, random);
      if (!second || !plausible(*second) || !onCourse(*second) ||
          turningPoint({last, *first}, *second) != kNoTurn)
        continue;
      return {std::move(*first), std::move(*second)};
    }
  return {};
}

/// Goes on where a step found nothing: looks ahead from the last node, then from nodes before it,
/// since the last ones may have gone astray. `longest`: the length from which that was tried last;
/// only a track that has become longer may give up nodes again. False if nothing was found; the
/// nodes are then as before.
bool BranchTracker::recover(std::vector<TrackedNode>& nodes, std::size_t& longest, Random& random) {
  const std::size_t count = nodes.size();
  for (const std::size_t back : {0U, 3U, 6U}) {
    if (back > 0 && (count <= longest || count < back + 2)) return false;
    std::vector<TrackedNode> kept(nodes.begin(), nodes.end() - static_cast<std::ptrdiff_t>(back));
    std::vector<TrackedNode> found = lookAhead(kept, random);
    if (found.empty()) continue;
    if (back > 0) longest = count;
    nodes = std::move(kept);
    std::move(found.begin(), found.end(), std::back_inserter(nodes));
    return true;
  }
  longest = std::max(longest, count);
  return false;
}

/// Appends nodes until a stop rule holds (thesis section 3.5).
void BranchTracker::follow(TrackedBranch& branch, std::span<const TrackedBranch* const> finished,
                           Random& random) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  // at a face of the volume the rays see half of the wall, and the centre stalls a radius before it
  const auto atFace = [&] {
    return !m_volume.geometry().containsWorld(nodes.back().centre +
                                              1.5 * nodes.back().radius * nodes.back().direction);
  };
  const auto stop = [&](StopReason reason) {
    branch.stopReason = atFace() ? StopReason::LeftVolume : reason;
    if (branch.stopReason == StopReason::NoValidCylinder) dropTip(nodes);
  };
  std::size_t longest = 0;
  for (;;) {
    m_progress.check();
    if (nodes.size() >= static_cast<std::size_t>(m_options.maxNodes))
      return stop(StopReason::StepLimit);
    const Guess guess = predict(nodes.back(), 1, courseOf(nodes));
    if (!m_volume.geometry().containsWorld(guess.centre)) return stop(StopReason::LeftVolume);
    std::optional<TrackedNode> node = fitNode(guess, 0.5 * m_options.inlierRate, random);
    if (node && isSwollen(nodes, *node)) node.reset();
    const std::size_t turn = node ? turningPoint(nodes, *node) : kNoTurn;
    const std::size_t before = nodes.size();
    if (node && turn == kNoTurn) {
      nodes.push_back(*node);
    } else {
      if (turn < nodes.size()) nodes.resize(std::max<std::size_t>(turn, 1));
      if (atFace() || !recover(nodes, longest, random))
        return stop(node ? StopReason::TurnedBack : StopReason::NoValidCylinder);
    }
    for (std::size_t i = std::min(before, nodes.size() - 1); i < nodes.size(); ++i)
      if (inCore(finished, nodes[i].centre)) {
        nodes.resize(i);
        return stop(StopReason::MetBranch);
      }
  }
}

TrackedBranch BranchTracker::track(const SeedBranch& seed, const TrackedBranch* parent,
                                   std::span<const TrackedBranch* const> finished, Random random) {
  TrackedBranch branch;
  m_bestRate = 0;
  m_inParent = false;
  if (parent) {
    branch.nodes = startChild(seed, *parent, branch.parentNode, random);
  } else if (auto first = startAt(seed.points[0], directionOf(seed).value_or(Vector3d::UnitZ()),
                                  directionOf(seed).has_value(), random)) {
    branch.nodes.push_back(std::move(*first));
  }
  if (branch.nodes.empty()) {
    branch.failure = m_inParent ? "what fits at the seed lies in its parent's lumen"
                                : "no valid cylinder at the seed: " +
                                      rateText(m_bestRate, 0.5 * m_options.inlierRate);
    return branch;
  }
  if (inCore(finished, branch.nodes.back().centre)) {
    branch.nodes.clear();
    branch.failure = "the seed leads into a vessel that another seed has tracked";
    return branch;
  }
  const bool bothWays = !parent && !seed.direction && seed.points.size() == 1;
  if (bothWays) {
    branch.nodes[0] = reversed(branch.nodes[0]);
    follow(branch, finished, random);
    std::reverse(branch.nodes.begin(), branch.nodes.end());
    for (TrackedNode& node : branch.nodes) node = reversed(std::move(node));
  }
  branch.clickNode = branch.nodes.size() - 1;
  follow(branch, finished, random);
  for (std::size_t i = 1; i < seed.points.size(); ++i)
    if (m_bestRate = 0; !passThrough(seed.points[i], branch, finished, random))
      branch.missedPoints.push_back("point " + std::to_string(i + 1) + ": no valid cylinder: " +
                                    rateText(m_bestRate, 0.5 * m_options.inlierRate));
  // the track may have been cut back to before its click
  branch.clickNode = std::min(branch.clickNode, branch.nodes.size() - 1);
  if (branch.nodes.size() < 2) {
    branch.nodes.clear();
    branch.failure = "a single cylinder fits at the seed, and nothing follows it";
  }
  return branch;
}

}  // namespace lumen::convert
