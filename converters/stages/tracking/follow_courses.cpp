// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/tracking/follow_courses.h"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/stages/tracking/aneurysm.h"
#include "converters/stages/tracking/nodes_along.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::NodeOrigin;
using formats::StopReason;

constexpr double kThinnestVoxels = 1;    // voxels: what is thinner is blurred to that
constexpr double kLeastFitted = 0.5;  // share of the nodes of a vessel that are cylinders
constexpr std::size_t kFewestFitted = 4;
constexpr double kAtFaceRadii = 1.5;  // an end this near to a face has left the volume

bool isFitted(const TrackedNode& node) {
  return node.origin != NodeOrigin::Bridged;
}

/// The nodes of a course that the cylinders bear out: without the ends at which none fits.
void dropBareEnds(std::vector<TrackedNode>& nodes) {
  const auto last = std::find_if(nodes.rbegin(), nodes.rend(), isFitted).base();
  nodes.erase(last, nodes.end());
  nodes.erase(nodes.begin(), std::find_if(nodes.begin(), nodes.end(), isFitted));
}

/// Drops the nodes up to the last one that lies in the lumen of the parent's course, within the
/// first half.
void dropInParent(std::vector<TrackedNode>& nodes, const SeedBranch& parent) {
  const auto isInside = [&](const TrackedNode& node) {
    return std::any_of(parent.points.begin(), parent.points.end(), [&](const SeedPoint& point) {
      return (node.centre - point.position).norm() < *point.radius;
    });
  };
  std::size_t first = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (isInside(nodes[i])) first = i + 1;
  nodes.erase(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(first));
}

bool isAtFace(const VolumeGeometry& geometry, const TrackedNode& node, double sign) {
  return !geometry.containsWorld(node.centre + sign * kAtFaceRadii * node.radius * node.direction);
}

TrackedBranch follow(TrackRun& run, const SeedBranch& seed, const SeedBranch* parent) {
  const VolumeGeometry& geometry = run.context.volume.geometry();
  const double least = kThinnestVoxels * geometry.voxelSize();
  std::vector<Vector3d> line;
  std::vector<double> radii;
  for (const SeedPoint& point : seed.points) {
    line.push_back(point.position);
    radii.push_back(std::max(least, point.radius.value_or(least)));
  }
  TrackedBranch branch;
  branch.nodes = nodesAlong(run, line, radii);
  if (parent) dropInParent(branch.nodes, *parent);
  dropBareEnds(branch.nodes);
  const auto fitted =
      static_cast<std::size_t>(std::count_if(branch.nodes.begin(), branch.nodes.end(), isFitted));
  if (fitted < kFewestFitted ||
      static_cast<double>(fitted) < kLeastFitted * static_cast<double>(branch.nodes.size())) {
    branch.failure = "cylinders fit at " + std::to_string(fitted) + " of its " +
                     std::to_string(branch.nodes.size()) + " places";
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

}  // namespace

void followCourses(const TrackContext& context, TrackedTree& tree, Progress& progress) {
  const std::size_t count = tree.seeds.size();
  tree.branches.resize(count);
  std::unordered_map<std::string, int> position;
  std::vector<int> parent(count, -1);
  for (std::size_t i = 0; i < count; ++i) {
    if (tree.seeds[i].parent) parent[i] = position.at(*tree.seeds[i].parent);
    position[tree.seeds[i].label] = static_cast<int>(i);
  }
  const auto forEach = [&](bool isVessel, const auto& work) {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      if (tree.isVessel(i) != isVessel) return;
      context.progress.check();
      TrackRun run(context, Random(context.options.seed, i));
      work(i, run);
      progress.advance();
    });
  };
  forEach(true, [&](std::size_t i, TrackRun& run) {
    const int p = parent[i];
    tree.branches[i] =
        follow(run, tree.seeds[i], p < 0 ? nullptr : &tree.seeds[static_cast<std::size_t>(p)]);
  });
  for (std::size_t i = 0; i < count; ++i) {
    int above = parent[i];
    while (above >= 0 && tree.branches[static_cast<std::size_t>(above)].nodes.empty())
      above = parent[static_cast<std::size_t>(above)];
    parent[i] = above;
  }
  forEach(false, [&](std::size_t i, TrackRun& run) {
    const TrackedBranch* above =
        parent[i] < 0 ? nullptr : &tree.branches[static_cast<std::size_t>(parent[i])];
    tree.branches[i] = captureAneurysm(run, tree.seeds[i], above);
  });
  for (std::size_t i = 0; i < count; ++i) {
    tree.branches[i].parentBranch = parent[i];
    if (parent[i] >= 0 && tree.isVessel(i)) tree.branches[i].startReason = StopReason::Unknown;
  }
}

}  // namespace lumen::convert
