// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/tracked_branch.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "converters/stages/tracking/cylinders/cylinder.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// The point closest to `p` on the segment a-b, as a fraction of it.
double fractionOnSegment(const Vector3d& a, const Vector3d& b, const Vector3d& p) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
}

void drop(const std::vector<bool>& isDropped, TrackedBranch& branch) {
  std::vector<TrackedNode> kept;
  std::size_t click = 0;
  for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
    if (i == branch.clickNode) click = kept.size();
    if (!isDropped[i]) kept.push_back(std::move(branch.nodes[i]));
  }
  branch.nodes = std::move(kept);
  branch.clickNode = branch.nodes.empty() ? 0 : std::min(click, branch.nodes.size() - 1);
}

}  // namespace

TrackedNode reversed(TrackedNode node) {
  node.direction = -node.direction;
  return node;
}

bool isAhead(const TrackedNode& node, const TrackedNode& next) {
  const Eigen::Vector3d chord = next.centre - node.centre;
  return chord.dot(node.direction) > 0 && chord.dot(next.direction) > 0;
}

std::vector<bool> turnedBack(std::span<const TrackedNode* const> nodes) {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Chain {
    double sum = 0, most = 0;  // of rates, of the chain that ends here, and of any up to here
    std::size_t before = kNone;
  };
  std::vector<Chain> chains(nodes.size());
  std::size_t last = kNone;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Chain& chain = chains[i];
    chain.most = i > 0 ? chains[i - 1].most : 0;
    if (!nodes[i]) continue;
    const double own = nodes[i]->inlierRate;
    chain.sum = own;
    for (std::size_t k = i; k-- > 0 && chains[k].most + own >= chain.sum;) {
      const double sum = chains[k].sum + own;
      const bool isBetter = sum > chain.sum || (chain.before == kNone && sum == chain.sum);
      if (!nodes[k] || !isBetter || !isAhead(*nodes[k], *nodes[i])) continue;
      chain.sum = sum;
      chain.before = k;
    }
    chain.most = std::max(chain.most, chain.sum);
    if (last == kNone || chain.sum >= chains[last].sum) last = i;
  }
  std::vector<bool> out(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) out[i] = nodes[i] != nullptr;
  for (std::size_t i = last; i != kNone; i = chains[i].before) out[i] = false;
  return out;
}

void dropTurnedBack(TrackedBranch& branch) {
  std::vector<const TrackedNode*> nodes;
  for (const TrackedNode& node : branch.nodes) nodes.push_back(&node);
  drop(turnedBack(nodes), branch);
}

void dropCrowded(TrackedBranch& branch) {
  constexpr double kLeastSpacing = 0.5 * kSpacingRadii;
  const std::vector<TrackedNode>& nodes = branch.nodes;
  std::vector<bool> isCrowded(nodes.size(), false);
  std::size_t kept = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if ((nodes[i].centre - nodes[kept].centre).norm() < kLeastSpacing * nodes[i].radius) {
      const bool isBetter = nodes[i].inlierRate > nodes[kept].inlierRate;
      isCrowded[isBetter ? kept : i] = true;
      if (!isBetter) continue;
    }
    kept = i;
  }
  drop(isCrowded, branch);
}

void dropDome(TrackedBranch& branch) {
  std::vector<TrackedNode>& nodes = branch.nodes;
  const auto isNarrow = [&] {
    const TrackedNode& last = nodes.back();
    return std::any_of(nodes.rbegin(), nodes.rend(), [&](const TrackedNode& node) {
      return last.radius < kNarrowest * node.radius &&
             (last.centre - node.centre).norm() < node.radius;
    });
  };
  while (nodes.size() > 1 && isNarrow()) nodes.pop_back();
  branch.clickNode = nodes.empty() ? 0 : std::min(branch.clickNode, nodes.size() - 1);
}

void reverseTrack(std::vector<TrackedNode>& nodes) {
  std::reverse(nodes.begin(), nodes.end());
  for (TrackedNode& node : nodes) node = reversed(std::move(node));
}

double measureLength(std::span<const TrackedNode> nodes) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    length += (nodes[i].centre - nodes[i - 1].centre).norm();
  return length;
}

ChainPoint closestOnChain(std::span<const TrackedNode> chain, const Vector3d& point) {
  ChainPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const std::size_t next = std::min(i + 1, chain.size() - 1);
    const TrackedNode &a = chain[i], &b = chain[next];
    const double t = fractionOnSegment(a.centre, b.centre, point);
    const Vector3d at = a.centre + t * (b.centre - a.centre);
    const double distance = (point - at).norm();
    if (distance < best.distance)
      best = {at, a.radius + t * (b.radius - a.radius), distance, t < 0.5 ? i : next};
  }
  return best;
}

void turnRound(TrackedBranch& branch) {
  reverseTrack(branch.nodes);
  branch.clickNode = branch.nodes.size() - 1 - std::min(branch.clickNode, branch.nodes.size() - 1);
  std::swap(branch.stopReason, branch.startReason);
  std::swap(branch.goesOn, branch.startGoesOn);
}

bool inCore(std::span<const TrackedBranch* const> branches, const TrackedNode& node) {
  return std::any_of(branches.begin(), branches.end(), [&](const TrackedBranch* branch) {
    if (branch->nodes.empty()) return false;
    const ChainPoint closest = closestOnChain(branch->nodes, node.centre);
    const double core = std::max(kCore * closest.radius, closest.radius - kCore * node.radius);
    return closest.distance < core;
  });
}

}  // namespace lumen::convert
