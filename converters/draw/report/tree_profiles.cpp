// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/tree_profiles.h"

#include <algorithm>

#include "converters/judge/measure/vessel_length.h"

namespace lumen::convert {

namespace {

using formats::Branch, formats::CenterlineTree;

/// Branches that leave each branch, by the place where they leave it.
std::vector<std::vector<std::uint32_t>> branchesOfEach(const CenterlineTree& tree) {
  std::vector<std::vector<std::uint32_t>> children(tree.branches.size());
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b)
    if (const std::int32_t from = tree.branches[b].parentNode; from != formats::kNoParent)
      children[tree.branch[static_cast<std::size_t>(from)]].push_back(b);
  for (auto& list : children)
    std::stable_sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
      return tree.branches[a].parentNode < tree.branches[b].parentNode;
    });
  return children;
}

TreeProfile makeProfile(const CenterlineTree& tree, std::uint32_t index,
                        const std::vector<std::uint32_t>& children,
                        const std::vector<double>& edge) {
  const Branch& branch = tree.branches[index];
  TreeProfile profile;
  profile.branch = index;
  profile.firstNode = branch.firstNode;
  double along = 0;
  for (std::uint32_t node = branch.firstNode; node < branch.firstNode + branch.nodeCount; ++node) {
    along += edge[node];
    profile.along.push_back(along);
    profile.radius.push_back(tree.radius[node]);
    if (!tree.inlierRate.empty()) profile.confidence.push_back(tree.inlierRate[node]);
  }
  for (const std::uint32_t child : children)
    profile.forks.push_back(
        profile
            .along[static_cast<std::size_t>(tree.branches[child].parentNode) - branch.firstNode]);
  return profile;
}

}  // namespace

std::vector<std::uint32_t> inTreeOrder(const CenterlineTree& tree) {
  const auto children = branchesOfEach(tree);
  std::vector<std::uint32_t> order, open;
  for (auto b = static_cast<std::uint32_t>(tree.branches.size()); b-- > 0;)
    if (tree.branches[b].parentNode == formats::kNoParent) open.push_back(b);
  while (!open.empty()) {
    const std::uint32_t branch = open.back();
    open.pop_back();
    order.push_back(branch);
    open.insert(open.end(), children[branch].rbegin(), children[branch].rend());
  }
  return order;
}

std::vector<TreeProfile> treeProfiles(const CenterlineTree& tree) {
  const auto children = branchesOfEach(tree);
  const std::vector<double> edge = vesselLengths(tree).edge;
  std::vector<TreeProfile> profiles;
  for (const std::uint32_t branch : inTreeOrder(tree))
    profiles.push_back(makeProfile(tree, branch, children[branch], edge));
  return profiles;
}

std::vector<std::size_t> drawnValues(std::span<const double> along, std::span<const float> values,
                                     std::size_t steps) {
  std::vector<std::size_t> drawn;
  const double width = along.empty() ? 0 : along.back();
  const auto stepOf = [&](std::size_t i) {
    return width > 0 ? static_cast<std::size_t>(along[i] / width * static_cast<double>(steps)) : 0;
  };
  for (std::size_t first = 0, next = 0; first < values.size(); first = next) {
    std::size_t least = first, most = first;
    for (next = first; next < values.size() && stepOf(next) == stepOf(first); ++next) {
      if (values[next] < values[least]) least = next;
      if (values[next] > values[most]) most = next;
    }
    for (const std::size_t i : {first, std::min(least, most), std::max(least, most), next - 1})
      if (drawn.empty() || i > drawn.back()) drawn.push_back(i);
  }
  return drawn;
}

ConfidenceShares confidenceShares(const CenterlineTree& tree) {
  constexpr int kClasses = 10;
  ConfidenceShares shares;
  shares.length.resize(kClasses);
  const std::vector<double> edge = vesselLengths(tree).edge;
  double sum = 0;
  for (std::uint32_t node = 0; node < tree.inlierRate.size(); ++node) {
    const double length = edge[node];
    const auto rate = static_cast<double>(tree.inlierRate[node]);
    const int at = std::clamp(static_cast<int>(rate * kClasses), 0, kClasses - 1);
    shares.length[static_cast<std::size_t>(at)] += length;
    shares.total += length;
    sum += rate * length;
  }
  shares.mean = shares.total > 0 ? sum / shares.total : 0;
  return shares;
}

}  // namespace lumen::convert
