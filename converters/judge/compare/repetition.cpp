// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/compare/repetition.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "converters/base/vectors.h"
#include "converters/geometry/tube_tree_distance.h"
#include "converters/judge/measure/vessel_length.h"

namespace lumen::convert {
namespace {

constexpr double kFound = 0.5;  // share of a vessel's nodes that a run must find

/// Whether each node of a tree lies in the lumen of another one.
std::vector<std::uint8_t> nodesWithin(const formats::CenterlineTree& tree,
                                      const formats::CenterlineTree& other) {
  std::vector<std::uint8_t> isWithin(tree.nodeCount(), 0);
  if (other.nodeCount() == 0) return isWithin;
  const TubeTreeDistance lumen(other);
  tbb::parallel_for(std::size_t{0}, tree.nodeCount(), [&](std::size_t n) {
    isWithin[n] = lumen.nearest(toEigen(tree.centre[n])).distance <= 0 ? 1 : 0;
  });
  return isWithin;
}

double meanOver(const formats::Branch& branch, std::span<const std::uint8_t> nodes) {
  const auto own = nodes.subspan(branch.firstNode, branch.nodeCount);
  return std::accumulate(own.begin(), own.end(), 0.0) / static_cast<double>(own.size());
}

/// Calls visit(branch index, length) for the long vessels of which less than half is found.
template <class Visit>
void eachLost(const formats::CenterlineTree& tree, const std::vector<double>& lengths,
              std::span<const std::uint8_t> isFound, const Visit& visit) {
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    if (lengths[b] > kLongVessel && meanOver(branch, isFound) < kFound) visit(b, lengths[b]);
  }
}

}  // namespace

Repetition compareRuns(const formats::Case& judged, std::span<const formats::Case> runs) {
  const formats::CenterlineTree& tree = judged.tree;
  Repetition out;
  out.runs = runs.size();
  const VesselLengths own = vesselLengths(tree);
  out.leastLength = out.greatestLength = own.total;
  out.nodes.assign(tree.nodeCount(), 0);
  std::vector<std::size_t> lost(tree.branches.size(), 0);
  std::vector<Repetition::Vessel> others;
  for (const formats::Case& run : runs) {
    const VesselLengths lengths = vesselLengths(run.tree);
    out.leastLength = std::min(out.leastLength, lengths.total);
    out.greatestLength = std::max(out.greatestLength, lengths.total);
    const std::vector<std::uint8_t> isFound = nodesWithin(tree, run.tree);
    for (std::size_t n = 0; n < isFound.size(); ++n) out.nodes[n] += isFound[n];
    eachLost(tree, own.branch, isFound, [&](std::size_t b, double) { ++lost[b]; });
    eachLost(run.tree, lengths.branch, nodesWithin(run.tree, tree), [&](std::size_t, double extra) {
      others.push_back({"", extra, 1});
    });
  }
  for (float& share : out.nodes) share /= static_cast<float>(std::max<std::size_t>(runs.size(), 1));
  for (std::size_t b = 0; b < tree.branches.size(); ++b) {
    const formats::Branch& branch = tree.branches[b];
    const auto first = out.nodes.begin() + branch.firstNode;
    out.branches.push_back(std::accumulate(first, first + branch.nodeCount, 0.0F) /
                           static_cast<float>(branch.nodeCount));
    if (lost[b] > 0) out.unstable.push_back({branch.label, own.branch[b], lost[b]});
  }
  out.unstable.insert(out.unstable.end(), others.begin(), others.end());
  return out;
}

}  // namespace lumen::convert
