// SPDX-License-Identifier: Apache-2.0
// Where tracks begin: at a click, beside a parent, back from a distant click; and aneurysms.
#include <algorithm>
#include <iterator>
#include <utility>

#include "converters/tracking/branch_tracker.h"

namespace lumen::convert {

using Eigen::Vector3d;
using formats::StopReason;

std::optional<Vector3d> directionOf(const SeedBranch& seed) {
  if (seed.direction) return seed.direction;
  if (seed.points.size() < 2) return std::nullopt;
  return (seed.points[1].position - seed.points[0].position).normalized();
}

/// A node at a click. Without a radius, trial radii from about one voxel up; the first that is
/// accepted, else the best.
std::optional<TrackedNode> BranchTracker::startAt(const SeedPoint& point, const Vector3d& direction,
                                                  bool smooth, Random& random) {
  std::vector<double> radii;
  if (point.radius)
    radii = {*point.radius};
  else
    for (double voxels = 1.25; voxels < 24; voxels *= 1.5)
      radii.push_back(voxels * m_volume.geometry().voxelSize());
  std::optional<TrackedNode> best;
  for (const double radius : radii) {
    std::optional<TrackedNode> node =
        fitNode({point.position, direction, radius, smooth}, 0.5 * m_options.inlierRate, random);
    if (!node || (best && node->inlierRate <= best->inlierRate)) continue;
    best = std::move(node);
    if (best->inlierRate >= m_options.inlierRate && best->points.size() > m_rays.rayCount() / 2)
      break;
  }
  return best;
}

/// A node from one of several guesses, each with several radii: the first that leads on and is not
/// in the lumen of `parent`, else the one that goes on farthest; well fitted ones before others.
std::optional<TrackedNode> BranchTracker::startBeside(const TrackedBranch& parent,
                                                      std::span<const Guess> guesses,
                                                      std::span<const double> radii,
                                                      Random& random) {
  std::optional<TrackedNode> best;
  int mostSteps = -1;
  for (const double minRate : {m_options.inlierRate, 0.5 * m_options.inlierRate})
    for (Guess guess : guesses)
      for (const double radius : radii) {
        guess.radius = radius;
        std::optional<TrackedNode> node = fitNode(guess, minRate, random);
        if (!node) continue;
        const ChainPoint nearest = closestOnChain(parent.nodes, node->centre);
        if (nearest.distance < 0.75 * nearest.radius) {
          m_inParent = true;
          continue;
        }
        const int steps = stepsFrom(*node, random);
        if (steps == kTrialSteps) return node;
        if (steps > mostSteps) {
          mostSteps = steps;
          best = std::move(node);
        }
      }
  return best;
}

/// The first nodes of a child, and where they hang on its parent. A click near the parent: beyond
/// the parent's wall on the way to the click (thesis section 3.6), else at the click itself. A
/// click farther away: there, and from there back to the parent.
std::vector<TrackedNode> BranchTracker::startChild(const SeedBranch& seed,
                                                   const TrackedBranch& parent, int& parentNode,
                                                   Random& random) {
  const SeedPoint& click = seed.points[0];
  const ChainPoint root = closestOnChain(parent.nodes, click.position);
  parentNode = static_cast<int>(root.node);
  const Vector3d toClick = root.distance > 0
                               ? Vector3d((click.position - root.position) / root.distance)
                               : parent.nodes[root.node].direction;
  const Vector3d outward = seed.direction.value_or(toClick);
  const Guess atParent{root.position + m_options.branchOffset * root.radius * outward, outward};
  const Guess atClick{click.position, directionOf(seed).value_or(toClick), 0,
                      directionOf(seed).has_value()};
  // a user's radius is an estimate; the parent's is an upper bound
  const double radius = click.radius.value_or(root.radius);
  std::vector<double> radii;
  for (const double share :
       click.radius ? std::vector{1.0, 0.7, 1.4} : std::vector{1.0, 0.7, 0.5, 0.35, 0.25})
    radii.push_back(share * radius);
  const bool far = root.distance > 2.0 * m_options.branchOffset * root.radius;
  std::vector<Guess> guesses{atParent, atClick};
  if (far) std::swap(guesses[0], guesses[1]);
  const auto start = startBeside(parent, guesses, radii, random);
  if (!start) return {};
  if (!far) return {*start};
  std::vector<TrackedNode> nodes = trackBack(*start, parent, random);
  parentNode = static_cast<int>(closestOnChain(parent.nodes, nodes.front().centre).node);
  return nodes;
}

/// The nodes from `goal` to `start`, in that order, by tracking from `start` against its direction;
/// `start` alone if that does not lead to `goal`, or not by a way that is straight enough to be
/// believed.
std::vector<TrackedNode> BranchTracker::trackBack(const TrackedNode& start,
                                                  const TrackedBranch& goal, Random& random) {
  TrackedBranch back;
  back.nodes.push_back(reversed(start));
  const TrackedBranch* const end = &goal;
  follow(back, {&end, 1}, random);
  double way = 0;
  for (std::size_t i = 1; i < back.nodes.size(); ++i)
    way += (back.nodes[i].centre - back.nodes[i - 1].centre).norm();
  const ChainPoint reached = closestOnChain(goal.nodes, back.nodes.back().centre);
  const bool arrived =
      back.stopReason == StopReason::MetBranch || reached.distance < 2.0 * reached.radius;
  if (!arrived || way > 3.0 * closestOnChain(goal.nodes, start.centre).distance)
    back.nodes.resize(1);
  std::reverse(back.nodes.begin(), back.nodes.end());
  for (TrackedNode& node : back.nodes) node = reversed(std::move(node));
  return std::move(back.nodes);
}

/// A further click on the same vessel that the track has missed: tracks from there back to the
/// track, gives up what the track has beyond the place of meeting, and goes on from the click.
/// False if nothing fits there.
bool BranchTracker::passThrough(const SeedPoint& point, TrackedBranch& branch,
                                std::span<const TrackedBranch* const> finished, Random& random) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  const ChainPoint closest = closestOnChain(nodes, point.position);
  if (closest.distance <= closest.radius) return true;
  const Vector3d away = (point.position - closest.position) / closest.distance;
  const auto start = startAt(point, away, false, random);
  if (!start) return false;
  std::vector<TrackedNode> way = trackBack(*start, branch, random);
  nodes.resize(closestOnChain(nodes, way.front().centre).node + 1);
  std::move(way.begin(), way.end(), std::back_inserter(nodes));
  follow(branch, finished, random);
  return true;
}

TrackedBranch BranchTracker::capture(const SeedBranch& seed, const TrackedBranch* parent) {
  TrackedBranch branch;
  branch.stopReason = StopReason::EndOfSeeds;
  for (const SeedPoint& point : seed.points) {
    m_rays.cast(point.position, 3.0 * point.radius.value(), m_points);
    if (m_points.count() == 0) continue;
    const float strongest = *std::max_element(m_points.strength.begin(), m_points.strength.end());
    TrackedNode node;
    node.centre = point.position;
    std::vector<double> distances;
    for (std::size_t i = 0; i < m_points.count(); ++i) {
      if (m_points.strength[i] < m_options.aneurysmGradient * strongest) continue;
      const Eigen::Vector3f p = (m_points.origin + m_points.offset(i)).cast<float>();
      node.points.push_back({p.x(), p.y(), p.z()});
      distances.push_back(m_points.offset(i).norm());
    }
    node.radius = median(distances);
    node.inlierRate =
        static_cast<double>(node.points.size()) / static_cast<double>(m_rays.rayCount());
    branch.nodes.push_back(std::move(node));
  }
  if (branch.nodes.empty()) {
    branch.failure = "no ray from its points met a wall";
    return branch;
  }
  const std::size_t count = branch.nodes.size();
  if (parent) {
    const ChainPoint root = closestOnChain(parent->nodes, branch.nodes[0].centre);
    branch.parentNode = static_cast<int>(root.node);
    if (count == 1)
      branch.nodes[0].direction = (branch.nodes[0].centre - root.position).normalized();
  } else if (count == 1) {
    branch.nodes[0].direction = seed.direction.value_or(Vector3d::UnitZ());
  }
  if (count == 1) branch.nodes[0].height = branch.nodes[0].radius;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const Vector3d segment = branch.nodes[i + 1].centre - branch.nodes[i].centre;
    branch.nodes[i].height = segment.norm();
    branch.nodes[i].direction = segment.normalized();
  }
  if (count > 1) {
    branch.nodes[count - 1].height = branch.nodes[count - 2].height;
    branch.nodes[count - 1].direction = branch.nodes[count - 2].direction;
  }
  return branch;
}

}  // namespace lumen::convert
