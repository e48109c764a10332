// SPDX-License-Identifier: Apache-2.0
#include "track_score.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <variant>

#include "converters/base/random.h"
#include "converters/base/vectors.h"
#include "converters/judge/compare/sampled_path.h"
#include "formats/case/topology.h"

namespace lumen::reproduce {
namespace {

using convert::ClosestPoint;
using convert::SampledPath;
using Eigen::Vector3d;

std::map<std::string, std::uint32_t> indexByLabel(const formats::CenterlineTree& tree) {
  std::map<std::string, std::uint32_t> index;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b) index[tree.branches[b].label] = b;
  return index;
}

std::vector<SampledPath> truePaths(const formats::CenterlineTree& tree, double voxel) {
  std::vector<SampledPath> paths;
  for (std::uint32_t b = 0; b < tree.branches.size(); ++b)
    paths.push_back(convert::samplePath(tree, b, 0.25 * voxel, false));
  return paths;
}

constexpr std::uint32_t kNone = ~0U;

std::uint32_t parentOf(const formats::CenterlineTree& tree, std::uint32_t branch) {
  const std::int32_t node = tree.branches[branch].parentNode;
  return node == formats::kNoParent ? kNone : tree.branch[static_cast<std::size_t>(node)];
}

bool holds(const SampledPath& path, const Vector3d& point) {
  const ClosestPoint closest = convert::closestOn(path.samples, point);
  return closest.distance <= closest.radius;
}

/// The nodes of a found branch against the true branch `index`.
void scoreNodes(const formats::CenterlineTree& found, const formats::Branch& branch,
                const formats::CenterlineTree& truth, const std::vector<SampledPath>& paths,
                std::uint32_t index, TrackOutcome& out, BranchOutcome& own) {
  const std::uint32_t parent = parentOf(truth, index);
  bool beginning = true;
  for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n) {
    const Vector3d centre = toEigen(found.centre[n]);
    beginning = beginning && parent != kNone && holds(paths[parent], centre);
    if (beginning) continue;
    const ClosestPoint closest = convert::closestOn(paths[index].samples, centre);
    const double rate =
        found.inlierRate.empty() ? std::nan("") : static_cast<double>(found.inlierRate[n]);
    out.nodes.push_back({closest.radius / out.voxel,
                         (static_cast<double>(found.radius[n]) - closest.radius) / out.voxel,
                         closest.distance / out.voxel, rate});
    if (closest.distance <= closest.radius || own.leaked) continue;
    for (std::uint32_t b = 0; b < paths.size() && !own.leaked; ++b)
      own.leaked = b != index && parentOf(truth, b) != index && holds(paths[b], centre);
  }
}

std::uint32_t nearestNode(const formats::CenterlineTree& tree, const formats::Branch& branch,
                          const Vector3d& point) {
  std::uint32_t best = branch.firstNode;
  for (std::uint32_t n = best; n < branch.firstNode + branch.nodeCount; ++n)
    if ((toEigen(tree.centre[n]) - point).norm() < (toEigen(tree.centre[best]) - point).norm())
      best = n;
  return best;
}

}  // namespace

TrackOutcome trackAndScore(const convert::Phantom& phantom, Progress& progress,
                           const convert::TrackOptions& options) {
  const formats::CenterlineTree& truth = phantom.truth.tree;
  const convert::TrackResult tracked =
      convert::trackFromSeeds(phantom.volume, phantom.seeds, options, progress);
  const convert::Comparison comparison =
      convert::compareCases(tracked.result, phantom.truth, progress);
  const formats::CenterlineTree& found = tracked.result.tree;
  TrackOutcome out;
  out.voxel = phantom.volume.geometry.voxelSize();
  out.score = comparison.score;
  const auto& parameters = tracked.result.metadata.steps.back().parameters;
  out.pointSpread = std::get<double>(parameters.at("point-spread"));
  const auto index = indexByLabel(found);
  const std::vector<SampledPath> paths = truePaths(truth, out.voxel);
  for (std::uint32_t b = 0; b < truth.branches.size(); ++b) {
    const formats::Branch& branch = truth.branches[b];
    if (branch.kind != formats::BranchKind::Vessel) continue;
    BranchOutcome own;
    own.label = branch.label;
    own.length = formats::branchLength(truth, branch);
    for (std::uint32_t n = branch.firstNode; n < branch.firstNode + branch.nodeCount; ++n)
      own.radius += static_cast<double>(truth.radius[n]) / branch.nodeCount / out.voxel;
    own.score = comparison.branches[b].score;
    const auto same = index.find(branch.label);
    own.started = same != index.end();
    if (own.started) scoreNodes(found, found.branches[same->second], truth, paths, b, out, own);
    out.branches.push_back(own);
  }
  return out;
}

void disturbClicks(convert::Phantom& phantom, const ClickError& error, std::uint64_t seed) {
  const formats::CenterlineTree& truth = phantom.truth.tree;
  const auto index = indexByLabel(truth);
  Random random(seed, 0x6572726f72ULL);
  for (convert::SeedBranch& click : phantom.seeds) {
    if (click.kind != formats::BranchKind::Vessel) continue;
    const formats::Branch& branch = truth.branches[index.at(click.label)];
    const std::uint32_t node = nearestNode(truth, branch, click.points[0].position);
    const Vector3d axis = toEigen(truth.direction[node]).normalized();
    const double radius = static_cast<double>(truth.radius[node]);
    const auto [u, v] = planeBasis(axis);
    const double angle = 2 * std::numbers::pi * random.uniform();
    const Vector3d across = std::cos(angle) * u + std::sin(angle) * v;
    click.points[0].position += error.offset * radius * across;
    if (error.tilt >= 0) {
      const double tilt = error.tilt * std::numbers::pi / 180;
      click.direction = (std::cos(tilt) * axis + std::sin(tilt) * across).normalized();
    }
    if (error.factor > 0) click.points[0].radius = error.factor * radius;
    // the first vessel has nothing to borrow a radius from
    if (error.factor < 0 && click.parent) click.points[0].radius.reset();
  }
}

}  // namespace lumen::reproduce
