// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/case_of_tracks.h"

#include <algorithm>
#include <utility>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

/// All new branches, in the seeds' order but for parents that come after a child.
std::vector<std::size_t> parentsFirst(const std::vector<TrackedBranch>& branches,
                                      std::size_t known) {
  std::vector<std::size_t> order;
  std::vector<bool> isPlaced(branches.size(), false);
  std::fill_n(isPlaced.begin(), known, true);
  while (order.size() < branches.size() - known)
    for (std::size_t i = known; i < branches.size(); ++i) {
      const int parent = branches[i].parentBranch;
      if (isPlaced[i] || (parent >= 0 && !isPlaced[static_cast<std::size_t>(parent)])) continue;
      isPlaced[i] = true;
      order.push_back(i);
    }
  return order;
}

/// Appends one tracked branch to the case. `firstNode`: of each branch by position in the seeds.
void appendBranch(const SeedBranch& seed, const TrackedBranch& branch,
                  const std::vector<std::int32_t>& firstNode, formats::Case& out) {
  formats::CenterlineTree& tree = out.tree;
  const auto first = static_cast<std::int32_t>(tree.nodeCount());
  if (branch.nodes.empty()) return;
  formats::Branch record;
  record.label = seed.label;
  record.kind = seed.kind;
  record.firstNode = static_cast<std::uint32_t>(first);
  record.nodeCount = static_cast<std::uint32_t>(branch.nodes.size());
  record.stopReason = branch.stopReason;
  if (branch.parentBranch >= 0)
    record.parentNode =
        firstNode[static_cast<std::size_t>(branch.parentBranch)] + branch.parentNode;
  double rates = 0;
  const bool hasRates = tree.inlierRate.size() == tree.nodeCount();
  for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
    const TrackedNode& node = branch.nodes[i];
    tree.centre.push_back(toVec3f(node.centre));
    tree.direction.push_back(toVec3f(node.direction));
    tree.radius.push_back(static_cast<float>(node.radius));
    tree.height.push_back(static_cast<float>(node.height));
    if (hasRates) tree.inlierRate.push_back(static_cast<float>(node.inlierRate));
    tree.parent.push_back(i == 0 ? record.parentNode : first + static_cast<std::int32_t>(i) - 1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    rates += node.inlierRate;
    auto& points = *out.points;
    points.position.insert(points.position.end(), node.points.begin(), node.points.end());
    points.offset.push_back(static_cast<std::uint32_t>(points.position.size()));
    if (out.models) out.models->offset.push_back(out.models->offset.back());
  }
  record.meanInlierRate = static_cast<float>(rates / static_cast<double>(branch.nodes.size()));
  tree.branches.push_back(std::move(record));
}

}  // namespace

void appendTracks(const std::vector<SeedBranch>& seeds, const std::vector<TrackedBranch>& branches,
                  std::size_t known, formats::Case& target) {
  std::vector<std::int32_t> firstNode(branches.size());
  for (std::size_t i = 0; i < known; ++i)
    firstNode[i] = static_cast<std::int32_t>(target.tree.branches[i].firstNode);
  std::vector<formats::NodeOrigin> origins = formats::nodeOriginsOf(target);
  for (const std::size_t i : parentsFirst(branches, known)) {
    firstNode[i] = static_cast<std::int32_t>(target.tree.nodeCount());
    appendBranch(seeds[i], branches[i], firstNode, target);
    for (const TrackedNode& node : branches[i].nodes) origins.push_back(node.origin);
  }
  setNodeOrigins(target, origins);
}

formats::Case caseOfTracks(const std::vector<SeedBranch>& seeds,
                           const std::vector<TrackedBranch>& branches) {
  formats::Case out;
  out.points.emplace();
  out.points->offset.push_back(0);
  appendTracks(seeds, branches, 0, out);
  return out;
}

}  // namespace lumen::convert
