// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/tree_places.h"

#include <algorithm>
#include <cmath>

#include "converters/base/vectors.h"
#include "converters/geometry/box.h"
#include "converters/judge/measure/vessel_length.h"
#include "formats/case/topology.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Radii from the volume's border to the first node of a vessel that comes in there.
constexpr double kAtFace = 1.5;
/// Radii from the axis of a vessel within which another one runs in it, and the least cosine of their
/// directions.
constexpr double kDeep = 0.5, kAlike = 0.8;
/// Radii of the wider vessel: a doubled stretch that is longer is no fork.
constexpr double kDoubledRadii = 4;
constexpr std::uint32_t kFewestPoor = 3;  // nodes of a stretch

template <class Place>
void sortByLength(std::vector<Place>& places) {
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.length > b.length; });
}

/// Whether a node lies deep in a branch and points along it.
bool runsIn(const formats::CenterlineTree& tree, std::uint32_t node, const formats::Branch& other) {
  const Vector3d point = toEigen(tree.centre[node]);
  for (std::uint32_t n = other.firstNode + 1; n < other.firstNode + other.nodeCount; ++n) {
    const Vector3d from = toEigen(tree.centre[n - 1]), edge = toEigen(tree.centre[n]) - from;
    if (edge.isZero()) continue;
    const double along = (point - from).dot(edge) / edge.squaredNorm();
    if (along < 0 || along > 1) continue;
    const double radius = (1 - along) * static_cast<double>(tree.radius[n - 1]) +
                          along * static_cast<double>(tree.radius[n]);
    if ((point - from - along * edge).norm() < kDeep * radius &&
        std::abs(toEigen(tree.direction[node]).dot(edge.normalized())) > kAlike)
      return true;
  }
  return false;
}

/// Calls visit(first, end, length) for each stretch of a branch whose nodes pass a test.
template <class Test, class Visit>
void eachStretch(const formats::CenterlineTree& tree, const formats::Branch& branch,
                 const Test& test, const Visit& visit) {
  const std::uint32_t last = branch.firstNode + branch.nodeCount;
  for (std::uint32_t first = branch.firstNode; first < last; ++first) {
    if (!test(first)) continue;
    std::uint32_t end = first + 1;
    double length = 0;
    for (; end < last && test(end); ++end)
      length += (toEigen(tree.centre[end]) - toEigen(tree.centre[end - 1])).norm();
    visit(first, end, length);
    first = end;
  }
}

/// The longest stretch of a branch that runs in another one, if it is long enough.
void addDoubled(const formats::CenterlineTree& tree, std::uint32_t b, std::uint32_t other,
                std::vector<DoubledTrack>& found) {
  const formats::Branch& in = tree.branches[other];
  DoubledTrack best{0, b, other, 0};
  eachStretch(
      tree, tree.branches[b], [&](std::uint32_t n) { return runsIn(tree, n, in); },
      [&](std::uint32_t first, std::uint32_t end, double length) {
        if (length <= best.length) return;
        best.length = length;
        best.node = (first + end) / 2;
      });
  if (best.length == 0) return;
  const auto widest = *std::max_element(tree.radius.begin() + in.firstNode,
                                        tree.radius.begin() + in.firstNode + in.nodeCount);
  const auto own = tree.radius[best.node];
  if (best.length > kDoubledRadii * static_cast<double>(std::max(widest, own)))
    found.push_back(best);
}

}  // namespace

std::vector<LooseTree> findLooseTrees(const formats::CenterlineTree& tree,
                                      const VolumeGeometry& geometry) {
  std::vector<LooseTree> trees;
  for (const TreeExtent& each : listTrees(tree, vesselLengths(tree)))
    trees.push_back({tree.branches[each.root].firstNode, each.branches, each.length});
  if (!trees.empty()) trees.erase(trees.begin());
  std::erase_if(trees, [&](const LooseTree& at) {
    const Vector3d place = geometry.indexFromWorld(toEigen(tree.centre[at.node]));
    const Vector3d far = geometry.cells().high().cast<double>() - place;
    const double nearest = place.cwiseMin(far).cwiseProduct(geometry.spacing).minCoeff();
    return nearest <= kAtFace * static_cast<double>(tree.radius[at.node]);
  });
  return trees;
}

std::vector<DoubledTrack> findDoubledTracks(const formats::CenterlineTree& tree) {
  std::vector<Box3d> boxes(tree.branches.size());
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n)
    boxes[tree.branch[n]].add(toEigen(tree.centre[n]), static_cast<double>(tree.radius[n]));
  const std::vector<double> length = vesselLengths(tree).branch;
  std::vector<DoubledTrack> found;
  for (std::uint32_t b = 0; b < length.size(); ++b)
    for (std::uint32_t other = 0; other < length.size(); ++other) {
      const bool isShorter = length[b] < length[other] || (length[b] == length[other] && b > other);
      const bool areVessels = tree.branches[b].kind == formats::BranchKind::Vessel &&
                              tree.branches[other].kind == formats::BranchKind::Vessel;
      if (b != other && isShorter && areVessels && boxes[b].meets(boxes[other]))
        addDoubled(tree, b, other, found);
    }
  sortByLength(found);
  return found;
}

std::vector<NodeStretch> findPoorStretches(const formats::CenterlineTree& tree,
                                           std::span<const Agreement> agreement) {
  std::vector<NodeStretch> found;
  for (const formats::Branch& branch : tree.branches)
    eachStretch(
        tree, branch, [&](std::uint32_t n) { return agreement[n] == Agreement::Poor; },
        [&](std::uint32_t first, std::uint32_t end, double length) {
          if (end - first >= kFewestPoor) found.push_back({first, end, length});
        });
  sortByLength(found);
  return found;
}

}  // namespace lumen::convert
