// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/cylinders/tracked_tree.h"

#include <algorithm>
#include <utility>

#include "converters/base/vectors.h"
#include "formats/case/node_origin.h"
#include "formats/case/vessel_system.h"

namespace lumen::convert {
namespace {

using formats::BranchKind;
using formats::StopReason;

TrackedNode nodeOf(const formats::Case& vesselCase, const std::vector<formats::NodeOrigin>& origins,
                   std::uint32_t i) {
  const formats::CenterlineTree& tree = vesselCase.tree;
  TrackedNode node;
  node.origin = origins[i];
  node.centre = toEigen(tree.centre[i]);
  node.direction = toEigen(tree.direction[i]).normalized();
  node.radius = double{tree.radius[i]};
  node.height = double{tree.height[i]};
  node.inlierRate = tree.inlierRate.empty() ? 0 : double{tree.inlierRate[i]};
  if (vesselCase.points) {
    const auto first = vesselCase.points->position.begin();
    const auto& offset = vesselCase.points->offset;
    node.points.assign(first + offset[i], first + offset[i + 1]);
  }
  return node;
}

/// All new branches, in the seeds' order but for parents that come after a child.
std::vector<std::size_t> parentsFirst(const TrackedTree& tree) {
  const auto& [seeds, branches, known] = tree;
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

/// Appends one tracked branch to the case. `firstNode`: the first node of each branch, by its
/// position in the tree.
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

/// Adds the remarks on one seed.
void remark(const SeedBranch& seed, const TrackedBranch& branch, TrackRemarks& out) {
  if (branch.nodes.empty()) {
    out.failures.push_back({seed.label, branch.failure});
    return;
  }
  for (const std::string& missed : branch.missedPoints)
    out.missedPoints.push_back({seed.label, missed});
  if (seed.kind != BranchKind::Vessel) return;
  if (!branch.unjoined.empty()) out.unjoined.push_back({seed.label, branch.unjoined});
  if (branch.parentBranch < 0 && branch.startReason != StopReason::Unknown)
    out.ends.push_back(
        {seed.label, true, branch.startReason, branch.nodes.front().centre, branch.startGoesOn});
  out.ends.push_back(
      {seed.label, false, branch.stopReason, branch.nodes.back().centre, branch.goesOn});
}

}  // namespace

TrackedTree makeTrackedTree(const formats::Case& vesselCase) {
  TrackedTree out;
  const formats::CenterlineTree& tree = vesselCase.tree;
  const auto origins = formats::readNodeOrigins(vesselCase);
  for (const formats::Branch& record : tree.branches) {
    SeedBranch seed;
    seed.label = record.label;
    seed.kind = record.kind;
    TrackedBranch branch;
    branch.stopReason = record.stopReason;
    if (record.parentNode != formats::kNoParent) {
      const auto above = static_cast<std::size_t>(record.parentNode);
      const std::uint32_t parent = tree.branch[above];
      branch.parentBranch = static_cast<int>(parent);
      branch.parentNode = static_cast<int>(above - tree.branches[parent].firstNode);
      seed.parent = tree.branches[parent].label;
    }
    for (std::uint32_t i = 0; i < record.nodeCount; ++i)
      branch.nodes.push_back(nodeOf(vesselCase, origins, record.firstNode + i));
    seed.points.push_back({branch.nodes.front().centre, std::nullopt});
    out.seeds.push_back(std::move(seed));
    out.branches.push_back(std::move(branch));
  }
  out.known = out.seeds.size();
  return out;
}

void appendTracks(const TrackedTree& tree, formats::Case& target) {
  std::vector<std::int32_t> firstNode(tree.branches.size());
  for (std::size_t i = 0; i < tree.known; ++i)
    firstNode[i] = static_cast<std::int32_t>(target.tree.branches[i].firstNode);
  std::vector<formats::NodeOrigin> origins = formats::readNodeOrigins(target);
  std::vector<bool> edited = formats::readEditedWalls(target);
  std::vector<formats::VesselSystem> systems = formats::readNodeSystems(target);
  for (const std::size_t i : parentsFirst(tree)) {
    firstNode[i] = static_cast<std::int32_t>(target.tree.nodeCount());
    appendBranch(tree.seeds[i], tree.branches[i], firstNode, target);
    for (const TrackedNode& node : tree.branches[i].nodes) origins.push_back(node.origin);
  }
  setNodeOrigins(target, origins);
  edited.resize(target.tree.nodeCount(), false);
  setEditedWalls(target, edited);
  systems.resize(target.tree.nodeCount(), formats::VesselSystem::Unknown);
  setNodeSystems(target, systems);
}

formats::Case caseOfTracks(const TrackedTree& tree) {
  formats::Case out;
  out.points.emplace();
  out.points->offset.push_back(0);
  appendTracks(tree, out);
  return out;
}

TrackRemarks remarksOn(const TrackedTree& tree) {
  TrackRemarks out;
  for (std::size_t i = tree.known; i < tree.seeds.size(); ++i)
    remark(tree.seeds[i], tree.branches[i], out);
  return out;
}

}  // namespace lumen::convert
