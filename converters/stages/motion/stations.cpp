// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/stations.h"

#include <algorithm>

#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

double lengthAbove(const formats::CenterlineTree& tree, std::uint32_t node) {
  const std::int32_t parent = tree.parent[node];
  if (parent < 0) return 0;
  return (toEigen(tree.centre[node]) - toEigen(tree.centre[static_cast<std::size_t>(parent)]))
      .norm();
}

std::vector<bool> chooseStations(const formats::CenterlineTree& tree) {
  std::vector<bool> isStation(tree.nodeCount(), false);
  for (const formats::Branch& branch : tree.branches) {
    isStation[branch.firstNode + branch.nodeCount - 1] = true;
    if (branch.parentNode < 0)
      isStation[branch.firstNode] = true;
    else
      isStation[static_cast<std::size_t>(branch.parentNode)] = true;
  }
  for (const formats::Branch& branch : tree.branches) {
    const std::uint32_t end = branch.firstNode + branch.nodeCount;
    double way = 0, left = 0;
    for (std::uint32_t i = branch.firstNode + 1; i < end; ++i) left += lengthAbove(tree, i);
    for (std::uint32_t i = branch.firstNode; i < end; ++i) {
      way += lengthAbove(tree, i);
      if (i > branch.firstNode) left -= lengthAbove(tree, i);
      // a tip is as far from the station before it as others are: alone it would be turned by little
      if (!isStation[i] && std::min(way, left) < double{tree.radius[i]}) continue;
      isStation[i] = true;
      way = 0;
    }
  }
  return isStation;
}

}  // namespace

Stations placeStations(const formats::CenterlineTree& tree) {
  constexpr std::uint32_t kNone = UINT32_MAX;
  const std::vector<bool> isStation = chooseStations(tree);
  Stations s;
  std::vector<double> way(tree.nodeCount(), 0.0);  // mm from the station above
  s.between.resize(tree.nodeCount(), {kNone, kNone, 0.0});
  std::vector<std::uint32_t> index(tree.nodeCount(), kNone);
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    const std::int32_t parent = tree.parent[i];
    std::int32_t above = -1;
    if (parent >= 0) {
      const auto p = static_cast<std::uint32_t>(parent);
      way[i] = lengthAbove(tree, i) + (isStation[p] ? 0.0 : way[p]);
      above = static_cast<std::int32_t>(isStation[p] ? index[p] : s.between[p].above);
    }
    if (!isStation[i]) {
      s.between[i].above = static_cast<std::uint32_t>(above);
      continue;
    }
    index[i] = static_cast<std::uint32_t>(s.node.size());
    s.node.push_back(i);
    s.parent.push_back(above);
    s.gap.push_back(way[i]);
    s.between[i] = {index[i], index[i], 0.0};
  }
  // from the tips up: the next station of the same branch
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodeCount()); i-- > 0;) {
    if (isStation[i]) continue;
    const std::uint32_t next = i + 1;  // of the same branch, as its last node is a station
    s.between[i].below = isStation[next] ? index[next] : s.between[next].below;
    const double gap = s.gap[s.between[i].below];
    s.between[i].share = gap > 0 ? way[i] / gap : 0.0;
  }
  s.length.assign(s.size(), 0.0);
  std::vector<int> children(s.size(), 0);
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (s.parent[i] < 0) continue;
    s.length[i] += 0.5 * s.gap[i];
    s.length[static_cast<std::size_t>(s.parent[i])] += 0.5 * s.gap[i];
    ++children[static_cast<std::size_t>(s.parent[i])];
  }
  for (std::size_t i = 0; i < s.size(); ++i)
    s.end.push_back(s.parent[i] < 0 ? (children[i] == 1 ? -1 : 0) : (children[i] == 0 ? 1 : 0));
  return s;
}

std::vector<Eigen::Vector3d> Stations::spread(const std::vector<Eigen::Vector3d>& moves) const {
  std::vector<Eigen::Vector3d> all;
  for (const Between& b : between)
    all.emplace_back((1 - b.share) * moves[b.above] + b.share * moves[b.below]);
  return all;
}

}  // namespace lumen::convert
