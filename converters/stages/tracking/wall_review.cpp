// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_review.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/stages/tracking/node_fit.h"
#include "converters/stages/tracking/path_rules.h"
#include "converters/stages/tracking/wall_section.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Length of the vessel on either side from which the expected radius is taken, in radii of the
/// node. A bulge that is longer than it is wide is therefore expected.
constexpr double kSideRadii = 4;
/// The fewest nodes on a side.
constexpr std::size_t kFewestNodesBeside = 3;
/// Largest distance of a new fit from its place, in expected radii.
constexpr double kOffLineRadii = 1.0;
/// First stream of random numbers, far from those of tracking.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 32;

/// The median radius of the nodes up to `reach` mm along the vessel to one side; empty if they are
/// too few.
std::optional<double> radiusBeside(const std::vector<TrackedNode>& nodes, std::size_t from,
                                   bool ahead, double reach) {
  std::vector<double> radii;
  double length = 0;
  for (std::size_t i = from; ahead ? i + 1 < nodes.size() : i > 0;) {
    const std::size_t next = ahead ? i + 1 : i - 1;
    length += (nodes[next].centre - nodes[i].centre).norm();
    if (length > reach) break;
    i = next;
    if (nodes[i].origin == formats::NodeOrigin::Measured) radii.push_back(nodes[i].radius);
  }
  if (radii.size() < kFewestNodesBeside) return std::nullopt;
  return median(std::move(radii));
}

/// The radius that the two sides let expect of a swollen node; empty if it is not swollen.
std::optional<double> expectedRadius(const TrackContext& context,
                                     const std::vector<TrackedNode>& nodes, std::size_t n) {
  const TrackedNode& node = nodes[n];
  if (node.origin != formats::NodeOrigin::Measured || node.inlierRate >= context.options.inlierRate)
    return std::nullopt;
  const auto before = radiusBeside(nodes, n, false, kSideRadii * node.radius);
  const auto after = radiusBeside(nodes, n, true, kSideRadii * node.radius);
  if (!before || !after || node.radius <= kSwollenRadii * std::max(*before, *after))
    return std::nullopt;
  return 0.5 * (*before + *after);
}

/// Fits the swollen nodes [first, end) between two trusted ones anew, or bridges them, along the
/// line between those two.
void replaceRun(TrackRun& run, std::vector<TrackedNode>& nodes, std::size_t first, std::size_t end,
                const std::vector<double>& expected) {
  const TrackedNode from = nodes[first - 1], to = nodes[end];
  const Vector3d chord = to.centre - from.centre;
  if (!(chord.norm() > 0)) return;
  const Vector3d direction = chord.normalized();
  const double step = chord.norm() / static_cast<double>(end - first + 1);
  for (std::size_t n = first; n < end; ++n) {
    const Vector3d place = from.centre + step * static_cast<double>(n - first + 1) * direction;
    const double radius = expected[n];
    NodeFit fit = fitNode(run, {place, direction, radius, true, 0.5 * step},
                          leastInlierRate(run.context.options));
    if (fit.node && fit.node->radius <= kSwollenRadii * radius &&
        (fit.node->centre - place).norm() <= kOffLineRadii * radius) {
      nodes[n] = std::move(*fit.node);
      continue;
    }
    TrackedNode bridge;
    bridge.origin = formats::NodeOrigin::Bridged;
    bridge.centre = place;
    bridge.direction = direction;
    bridge.radius = radius;
    bridge.height = 2 * step;
    nodes[n] = std::move(bridge);
  }
}

void replaceSwollen(TrackRun& run, std::vector<TrackedNode>& nodes) {
  std::vector<double> expected;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    expected.push_back(expectedRadius(run.context, nodes, n).value_or(0));
  for (std::size_t n = 0; n < nodes.size();) {
    std::size_t end = n;
    while (end < nodes.size() && expected[end] > 0) ++end;
    // a side has nodes, so no run begins or ends the vessel
    if (end > n) replaceRun(run, nodes, n, end, expected);
    n = end + 1;
  }
}

}  // namespace

void reviewWalls(const TrackContext& context, TrackedTree& tree) {
  tbb::parallel_for(tree.known, tree.branches.size(), [&](std::size_t i) {
    if (!tree.isVessel(i)) return;
    TrackRun run(context, Random(context.options.seed, kFirstStream + i));
    replaceSwollen(run, tree.branches[i].nodes);
    fitSections(run, tree.branches[i].nodes);
  });
}

}  // namespace lumen::convert
