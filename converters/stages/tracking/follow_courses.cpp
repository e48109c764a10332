// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/follow_courses.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/stages/tracking/branch_lumen.h"
#include "converters/stages/tracking/path_rules.h"
#include "converters/stages/tracking/sac_walls.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::StopReason;

constexpr double kShortestVoxels = 4;  // length of a vessel beyond the wall that it leaves
/// First stream of random numbers of the search at bridged nodes, far from those of tracking and
/// of the review of walls.
constexpr std::uint64_t kSearchStream = std::uint64_t{1} << 33;

/// Keeps the longest stretch that begins and ends with a cylinder and has cylinders at a share of
/// `leastFitted` of its nodes or more; the first of several. So a course that follows a vessel, and
/// then something else, keeps the vessel alone.
void keepSupported(std::vector<TrackedNode>& nodes, double leastFitted) {
  struct Stretch {
    std::size_t first = 0, end = 0;
  } best;
  for (std::size_t first = 0; nodes.size() - first > best.end - best.first; ++first) {
    if (!isFitted(nodes[first])) continue;
    std::size_t fitted = 0;
    for (std::size_t i = first; i < nodes.size(); ++i) {
      if (!isFitted(nodes[i])) continue;
      ++fitted;
      const std::size_t length = i + 1 - first;
      if (static_cast<double>(fitted) < leastFitted * static_cast<double>(length)) continue;
      if (length > best.end - best.first) best = {first, i + 1};
    }
  }
  nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(best.end), nodes.end());
  nodes.erase(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(best.first));
}

/// The longest stretch of a vessel that no vessel before it holds.
struct OutsideStretch {
  std::size_t first = 0, end = 0;
  double length = 0;           ///< mm
  double neighbourRadius = 0;  ///< greatest radius of the vessels beside it, mm
};

OutsideStretch findOutside(std::span<const BranchLumen> before,
                           const std::vector<TrackedNode>& nodes, double apart) {
  OutsideStretch best, here;
  double widest = 0;
  for (std::size_t i = 0; i <= nodes.size(); ++i) {
    const double around =
        i < nodes.size() ? radiusAround(before, nodes[i].centre, apart * nodes[i].radius) : 0;
    widest = std::max(widest, around);
    if (i < nodes.size() && around == 0) continue;
    here.end = i;
    here.length = measureLength(std::span(nodes).subspan(here.first, here.end - here.first));
    if (here.length > best.length) best = here;
    here.first = i + 1;
  }
  best.neighbourRadius = widest;
  return best;
}

/// Leaves the stretch of a vessel outside of those that it hangs on. A stretch that is shorter than
/// these are wide, or than it is wide itself, is a bump of their wall.
void dropInside(std::span<const BranchLumen> before, double voxel, double apart,
                TrackedBranch& branch) {
  if (branch.nodes.empty() || before.empty()) return;
  const OutsideStretch out = findOutside(before, branch.nodes, apart);
  std::vector<double> radii;
  for (std::size_t i = out.first; i < out.end; ++i) radii.push_back(branch.nodes[i].radius);
  const double own = radii.empty() ? 0 : upperMedian(radii);
  if (out.length < std::max({out.neighbourRadius, 2 * own, kShortestVoxels * voxel})) {
    branch.nodes.clear();
    branch.failure = "it is a bump on the wall of the vessel that it leaves";
    return;
  }
  if (out.end < branch.nodes.size()) branch.stopReason = StopReason::MetBranch;
  keepStretch(branch, out.first, out.end);
}

TrackedBranch follow(TrackRun& run, const SeedBranch& seed) {
  const VolumeGeometry& geometry = run.context.volume.geometry();
  const double least = geometry.voxelSize();  // what is thinner is blurred to that
  std::vector<Vector3d> line;
  std::vector<double> radii;
  for (const SeedPoint& point : seed.points) {
    line.push_back(point.position);
    radii.push_back(std::max(least, point.radius.value_or(least)));
  }
  TrackedBranch branch;
  branch.nodes = nodesAlong(run, line, radii);
  const std::size_t places = branch.nodes.size();
  keepSupported(branch.nodes, run.context.rules.leastFitted);
  const auto fitted =
      static_cast<std::size_t>(std::count_if(branch.nodes.begin(), branch.nodes.end(), isFitted));
  if (fitted < kFewestFitted) {
    branch.failure = "cylinders fit at " + std::to_string(fitted) + " of its " +
                     std::to_string(places) + " places";
    branch.nodes.clear();
    return branch;
  }
  branch.clickNode = branch.nodes.size() / 2;
  branch.stopReason = isAtFace(geometry, branch.nodes.back(), 1) ? StopReason::LeftVolume
                                                                 : StopReason::NoValidCylinder;
  branch.startReason = isAtFace(geometry, branch.nodes.front(), -1) ? StopReason::LeftVolume
                                                                    : StopReason::NoValidCylinder;
  return branch;
}

/// The nearest of the branches [first, end) to a place.
int nearestBranch(const TrackedTree& tree, std::size_t first, std::size_t end,
                  const Vector3d& place) {
  std::size_t nearest = first;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i < end; ++i) {
    if (tree.branches[i].nodes.empty()) continue;
    const double distance = closestOnChain(tree.branches[i].nodes, place).distance;
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  return static_cast<int>(nearest);
}

/// Adds further parts of branches behind these, as roots. Children go to the nearest part.
void addParts(std::vector<std::vector<TrackedBranch>> further, TrackedTree& tree,
              std::vector<int>& parent) {
  TrackedTree all{{}, {}, tree.known};
  std::vector<int> from;
  std::vector<std::size_t> place;  // of the first part of each branch
  for (std::size_t i = 0; i < further.size(); ++i) {
    place.push_back(all.branches.size());
    all.seeds.push_back(tree.seeds[i]);
    all.branches.push_back(std::move(tree.branches[i]));
    from.push_back(parent[i]);
    for (std::size_t k = 0; k < further[i].size(); ++k) {
      SeedBranch seed = tree.seeds[i];
      seed.label += "-" + std::to_string(k + 2);
      seed.parent.reset();
      all.seeds.push_back(std::move(seed));
      all.branches.push_back(std::move(further[i][k]));
      from.push_back(-1);
    }
  }
  place.push_back(all.branches.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (from[i] < 0) continue;
    const auto above = static_cast<std::size_t>(from[i]);
    const std::vector<TrackedNode>& nodes = all.branches[i].nodes;
    from[i] = nodes.empty()
                  ? static_cast<int>(place[above])
                  : nearestBranch(all, place[above], place[above + 1], nodes.front().centre);
  }
  tree = std::move(all);
  parent = std::move(from);
}

}  // namespace

void followCourses(const TrackContext& context, TrackedTree& tree, Progress& progress) {
  std::size_t count = tree.seeds.size();
  tree.branches.resize(count);
  std::unordered_map<std::string, int> position;
  std::vector<int> parent(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    if (tree.seeds[i].parent) parent[i] = position.at(*tree.seeds[i].parent);
    position[tree.seeds[i].label] = static_cast<int>(i);
  }
  const auto forEach = [&](bool isVessel, const auto& work) {
    tbb::parallel_for(tree.known, count, [&](std::size_t i) {
      if (tree.isVessel(i) != isVessel) return;
      context.progress.check();
      TrackRun run(context, Random(context.options.seed, i));
      work(i, run);
      progress.advance();
    });
  };
  forEach(true,
          [&](std::size_t i, TrackRun& run) { tree.branches[i] = follow(run, tree.seeds[i]); });
  // parents come first and lose what lies in theirs before their children are compared with them
  for (std::size_t i = tree.known; i < count; ++i) {
    context.progress.check();
    std::vector<BranchLumen> before;
    for (std::size_t k = 0; k < tree.known; ++k) before.emplace_back(tree.branches[k]);
    for (int p = parent[i]; p >= static_cast<int>(tree.known);
         p = parent[static_cast<std::size_t>(p)])
      before.emplace_back(tree.branches[static_cast<std::size_t>(p)]);
    dropInside(before, context.volume.geometry().voxelSize(), context.rules.apart,
               tree.branches[i]);
  }
  if (context.isNoVessel) addParts(takeWithoutEdges(context, tree), tree, parent);
  count = tree.seeds.size();
  for (std::size_t i = tree.known; i < count; ++i) {
    int above = parent[i];
    while (above >= 0 && tree.branches[static_cast<std::size_t>(above)].nodes.empty())
      above = parent[static_cast<std::size_t>(above)];
    parent[i] = above;
  }
  // a sac bulges out of a vessel: one whose vessel was none, such as marrow in its bone, is none
  forEach(false, [&](std::size_t i, TrackRun& run) {
    if (parent[i] < 0) return;
    tree.branches[i] =
        captureAneurysm(run, tree.seeds[i], &tree.branches[static_cast<std::size_t>(parent[i])]);
  });
  for (std::size_t i = tree.known; i < count; ++i) {
    tree.branches[i].parentBranch = parent[i];
    if (parent[i] >= 0 && tree.isVessel(i)) tree.branches[i].startReason = StopReason::Unknown;
  }
}

std::vector<SeedBranch> stretchesOutside(std::vector<SeedBranch> courses, const TrackedTree& tree) {
  std::vector<BranchLumen> known;
  for (std::size_t k = 0; k < tree.known; ++k) known.emplace_back(tree.branches[k]);
  std::vector<SeedBranch> out;
  std::unordered_map<std::string, std::string> lastStretch;  // the last stretch of each course
  for (SeedBranch& course : courses) {
    SeedBranch stretch;
    std::size_t count = 0;
    const auto close = [&] {
      if (stretch.points.size() > 1) {
        stretch.kind = course.kind;
        stretch.label = course.label + (count == 0 ? "" : "-" + std::to_string(count + 1));
        ++count;
        // one that begins at its parent's axis hangs on that; all others are roots, to be joined
        const bool isWhole = stretch.points.front().position == course.points.front().position;
        if (isWhole && course.parent && lastStretch.contains(*course.parent))
          stretch.parent = lastStretch.at(*course.parent);
        lastStretch[course.label] = stretch.label;
        out.push_back(std::move(stretch));
      }
      stretch = {};
    };
    for (const SeedPoint& point : course.points)
      if (radiusAround(known, point.position) > 0)
        close();
      else
        stretch.points.push_back(point);
    close();
  }
  return out;
}

void dropUnsupported(const TrackContext& context, TrackedTree& tree) {
  std::vector<int> children(tree.branches.size(), 0);
  for (const TrackedBranch& branch : tree.branches)
    if (branch.parentBranch >= 0 && !branch.nodes.empty())
      ++children[static_cast<std::size_t>(branch.parentBranch)];
  // children come after their parents, but for those that were joined to another vessel
  for (std::size_t i = tree.branches.size(); i-- > tree.known;) {
    TrackedBranch& branch = tree.branches[i];
    if (!tree.isVessel(i) || branch.nodes.empty() || children[i] > 0) continue;
    const auto fitted = std::count_if(branch.nodes.begin(), branch.nodes.end(), isFitted);
    const auto count = static_cast<double>(branch.nodes.size());
    if (static_cast<double>(fitted) >= context.rules.leastFitted * count) continue;
    branch.failure = "most of it is a bridge through places where no cylinder fits";
    branch.nodes.clear();
    if (branch.parentBranch >= 0) --children[static_cast<std::size_t>(branch.parentBranch)];
  }
}

void searchBridged(const TrackContext& context, const WallShape& shape, TrackedTree& tree) {
  std::vector<BranchLumen> lumens;
  for (const TrackedBranch& branch : tree.branches) lumens.emplace_back(branch);
  std::vector<std::vector<TrackedNode>> found(tree.branches.size());
  tbb::parallel_for(tree.known, tree.branches.size(), [&](std::size_t i) {
    found[i] = tree.branches[i].nodes;
    if (!tree.isVessel(i)) return;
    TrackRun run(context, Random(context.options.seed, kSearchStream + i));
    for (std::size_t n = 1; n + 1 < found[i].size(); ++n) {
      context.progress.check();
      if (isFitted(found[i][n]) || isInAnother(lumens, i, found[i][n].centre)) continue;
      auto node = nodeBetween(run, found[i][n - 1], found[i][n], found[i][n + 1]);
      if (!node) continue;
      TrackedBranch one;
      one.nodes.push_back(std::move(*node));
      correctWalls(one, tree.seeds[i].kind, shape);
      found[i][n] = std::move(one.nodes[0]);
    }
  });
  for (std::size_t i = tree.known; i < tree.branches.size(); ++i)
    tree.branches[i].nodes = std::move(found[i]);
}

}  // namespace lumen::convert
