// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/wall_review.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/stages/tracking/wall_section.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

/// Times the radius of the vessel on either side: a wider node is swollen (as in section 1.5).
constexpr double kSwollenOnBoth = 1.5;
/// Of the node's radius: how far to either side the vessel tells what is expected. A bulge that is
/// longer than it is wide is expected, then.
constexpr double kSide = 4;
/// The fewest nodes on a side, and of the expected radius: how far aside a new fit may lie.
constexpr std::size_t kFewestBeside = 3;
constexpr double kMostOffLine = 1.0;
/// Of random numbers: far from those of tracking.
constexpr std::uint64_t kFirstStream = std::uint64_t{1} << 32;

/// The median radius of the nodes up to `reach` mm along the path to one side; nothing if they are
/// too few.
std::optional<double> radiusBeside(const std::vector<TrackedNode>& nodes, std::size_t from,
                                   bool ahead, double reach) {
  std::vector<double> radii;
  double way = 0;
  for (std::size_t i = from; ahead ? i + 1 < nodes.size() : i > 0;) {
    const std::size_t next = ahead ? i + 1 : i - 1;
    way += (nodes[next].centre - nodes[i].centre).norm();
    if (way > reach) break;
    i = next;
    if (nodes[i].origin == formats::NodeOrigin::Measured) radii.push_back(nodes[i].radius);
  }
  if (radii.size() < kFewestBeside) return std::nullopt;
  return median(std::move(radii));
}

/// What the two sides let expect of a node that is swollen; nothing if it is not.
std::optional<double> expectedInstead(const TrackContext& context,
                                      const std::vector<TrackedNode>& nodes, std::size_t n) {
  const TrackedNode& node = nodes[n];
  if (node.origin != formats::NodeOrigin::Measured || node.inlierRate >= context.options.inlierRate)
    return std::nullopt;
  const auto before = radiusBeside(nodes, n, false, kSide * node.radius);
  const auto after = radiusBeside(nodes, n, true, kSide * node.radius);
  if (!before || !after || node.radius <= kSwollenOnBoth * std::max(*before, *after))
    return std::nullopt;
  return 0.5 * (*before + *after);
}

/// A swollen run [first, end) between two trusted nodes: fitted anew or bridged, along the line
/// between those.
void replaceRun(const TrackContext& context, std::vector<TrackedNode>& nodes, std::size_t first,
                std::size_t end, const std::vector<double>& expected, Random& random,
                TrackWorkspace& workspace) {
  const TrackedNode from = nodes[first - 1], to = nodes[end];
  const Vector3d chord = to.centre - from.centre;
  if (!(chord.norm() > 0)) return;
  const Vector3d direction = chord.normalized();
  const double step = chord.norm() / static_cast<double>(end - first + 1);
  for (std::size_t n = first; n < end; ++n) {
    const Vector3d place = from.centre + step * static_cast<double>(n - first + 1) * direction;
    const double radius = expected[n];
    NodeFit fit = fitNode(context, {place, direction, radius, true, 0.5 * step},
                          leastInlierRate(context.options), random, workspace);
    if (fit.node && fit.node->radius <= kSwollenOnBoth * radius &&
        (fit.node->centre - place).norm() <= kMostOffLine * radius) {
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

void replaceSwollen(const TrackContext& context, std::vector<TrackedNode>& nodes, Random& random,
                    TrackWorkspace& workspace) {
  std::vector<double> expected;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    expected.push_back(expectedInstead(context, nodes, n).value_or(0));
  for (std::size_t n = 0; n < nodes.size();) {
    std::size_t end = n;
    while (end < nodes.size() && expected[end] > 0) ++end;
    // a side has nodes, so no run begins or ends the vessel
    if (end > n) replaceRun(context, nodes, n, end, expected, random, workspace);
    n = end + 1;
  }
}

}  // namespace

void reviewWalls(const TrackContext& context, const std::vector<SeedBranch>& seeds,
                 std::size_t known, std::vector<TrackedBranch>& branches) {
  tbb::parallel_for(known, branches.size(), [&](std::size_t i) {
    if (seeds[i].kind != formats::BranchKind::Vessel) return;
    TrackWorkspace workspace(context);
    Random random(context.options.seed, kFirstStream + i);
    replaceSwollen(context, branches[i].nodes, random, workspace);
    fitSections(context, branches[i].nodes, workspace);
  });
}

}  // namespace lumen::convert
