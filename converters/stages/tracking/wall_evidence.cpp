// SPDX-License-Identifier: Apache-2.0
// Declared in follow_courses.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/stages/tracking/branch_lumen.h"
#include "converters/stages/tracking/follow_courses.h"
#include "converters/voxels/profile_edge.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

constexpr int kEdgeDirections = 16;
// A wall is off if its edge is farther than a voxel, or than a quarter of the radius, as sections
// are not quite round.
constexpr double kOffRadii = 0.25;
// Cylinders fit where half of the candidates agree, so that by chance half of the wall may be off.
constexpr double kChanceOfOutliers = 0.5;
// Shares of chance above which a vessel is none, which is halfway between a perfect wall and one by
// chance, and above which it is cut where it leads into something else.
constexpr double kShareOfVessel = 0.5, kShareOfBone = 0.75;
constexpr double kWindowRadii = 8;  // radii to both sides of a node that decide whether it is cut
constexpr double kLeastContrast = 0.25;     // of the branch's median: fainter edges are texture
constexpr double kClearOf[] = {0.5, 1, 2};  // voxels beyond the wall at which no other lumen may be

/// Counts of the places around a node.
struct EdgeCounts {
  int judged = 0, off = 0;
  bool isAtRim = false;  ///< the node itself lies on the rim of what is no vessel
  double chance = 0;     ///< number of places that would be off if edges lay at random
};

/// One place of a wall whose edge was looked for.
struct EdgePlace {
  std::size_t node = 0;
  double contrast = 0;  ///< 0: there is no edge, or one of the wrong polarity
  bool isOff = true;
};

class WallEvidence {
public:
  WallEvidence(const TrackContext& context, const TrackedTree& tree) : m_context(context) {
    for (const TrackedBranch& branch : tree.branches) m_lumens.emplace_back(branch);
  }

  /// The places around each node of a branch.
  [[nodiscard]] std::vector<EdgeCounts> along(const TrackedBranch& branch, std::size_t own) const {
    std::vector<EdgeCounts> counts(branch.nodes.size());
    std::vector<EdgePlace> places;
    for (std::size_t n = 0; n < branch.nodes.size(); ++n)
      if (isFitted(branch.nodes[n])) look(branch.nodes[n], n, own, places);
    if (const auto& isRim = m_context.isNoVessel.isRim)
      for (std::size_t n = 0; n < branch.nodes.size(); ++n)
        counts[n].isAtRim = isRim(branch.nodes[n].centre);
    std::vector<double> contrasts;
    for (const EdgePlace& place : places)
      if (place.contrast > 0) contrasts.push_back(place.contrast);
    const double least = contrasts.empty() ? 0 : kLeastContrast * upperMedian(contrasts);
    for (const EdgePlace& place : places) {
      EdgeCounts& count = counts[place.node];
      ++count.judged;
      if (place.isOff || place.contrast < least) ++count.off;
      const double radius = branch.nodes[place.node].radius;
      count.chance += kChanceOfOutliers * (1 - offFrom(radius) / reach(radius).outward);
    }
    return counts;
  }

private:
  [[nodiscard]] double voxel() const { return m_context.volume.geometry().voxelSize(); }
  [[nodiscard]] ProfileReach reach(double radius) const { return profileReach(radius, voxel()); }
  [[nodiscard]] double offFrom(double radius) const {
    return std::max(voxel(), kOffRadii * radius);
  }

  void look(const TrackedNode& node, std::size_t n, std::size_t own,
            std::vector<EdgePlace>& places) const {
    const auto [across, up] = planeBasis(node.direction);
    std::vector<float> values;
    for (int k = 0; k < kEdgeDirections; ++k) {
      const double angle = 2 * std::numbers::pi * k / kEdgeDirections;
      const Vector3d outward = std::cos(angle) * across + std::sin(angle) * up;
      const Vector3d wall = node.centre + node.radius * outward;
      if (std::any_of(std::begin(kClearOf), std::end(kClearOf), [&](double clear) {
            return isInAnother(m_lumens, own, wall + clear * voxel() * outward);
          }))
        continue;
      EdgePlace place;
      place.node = n;
      if (measure(node, outward, values, place)) places.push_back(place);
    }
  }

  /// Looks for the edge in one direction; false if the wall lies outside of the volume, or beside what is brighter than
  /// the lumen: bone or metal, which say nothing about the vessel.
  bool measure(const TrackedNode& node, const Vector3d& outward, std::vector<float>& values,
               EdgePlace& place) const {
    const VolumeGeometry& geometry = m_context.volume.geometry();
    const double step = voxel() / kSamplesPerVoxel;
    const ProfileReach extent = reach(node.radius);
    const auto wall = static_cast<std::size_t>(extent.inward / step);
    values.resize(wall + static_cast<std::size_t>(extent.outward / step) + 1);
    const Vector3d start = node.centre + (node.radius - static_cast<double>(wall) * step) * outward;
    m_context.volume.sampleLine(
        geometry.indexFromWorld(start),
        (geometry.direction.transpose() * outward * step).cwiseQuotient(geometry.spacing), values);
    if (m_context.options.dark)
      for (float& value : values) value = -value;
    if (std::isnan(values[wall])) return false;
    const ProfileEdge edge = findEdge(values, wall);
    if (m_context.isNoVessel.isByLevel && edge.kind == EdgeKind::Rises) return false;
    if (edge.kind != EdgeKind::Falls) return true;
    place.contrast = std::abs(edge.contrast());
    place.isOff = std::abs(edge.at * step) > offFrom(node.radius);
    return true;
  }

  const TrackContext& m_context;
  std::vector<BranchLumen> m_lumens;
};

struct Stretch {
  std::size_t first = 0, end = 0;
};

/// Whether the wall is off along nodes, as often as `share` of chance, or most lie on a rim.
bool isOff(std::span<const EdgeCounts> counts, double share) {
  double off = 0, chance = 0;
  std::size_t atRim = 0;
  for (const EdgeCounts& count : counts) {
    off += count.off;
    chance += count.chance;
    atRim += count.isAtRim ? 1 : 0;
  }
  return off > share * chance || 2 * atRim > counts.size();
}

/// The nodes within a window around one.
Stretch windowAround(const std::vector<TrackedNode>& nodes, std::size_t n) {
  const double window = kWindowRadii * nodes[n].radius;
  Stretch in{n, n + 1};
  for (double length = 0; in.first > 0; --in.first) {
    length += (nodes[in.first].centre - nodes[in.first - 1].centre).norm();
    if (length > window) break;
  }
  for (double length = 0; in.end < nodes.size(); ++in.end) {
    length += (nodes[in.end].centre - nodes[in.end - 1].centre).norm();
    if (length > window) break;
  }
  return in;
}

/// The stretches along which the volume has the wall, in order.
std::vector<Stretch> stretchesWithEdges(const std::vector<TrackedNode>& nodes,
                                        const std::vector<EdgeCounts>& counts) {
  std::vector<Stretch> with;
  const std::span all(counts);
  const auto add = [&](std::size_t first, std::size_t end) {
    if (first < end && !isOff(all.subspan(first, end - first), kShareOfVessel))
      with.push_back({first, end});
  };
  std::size_t first = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Stretch in = windowAround(nodes, n);
    if (!isOff(all.subspan(in.first, in.end - in.first), kShareOfBone)) continue;
    add(first, n);
    first = n + 1;
  }
  add(first, nodes.size());
  return with;
}

std::string failureText(const std::vector<EdgeCounts>& counts) {
  int off = 0, judged = 0;
  for (const EdgeCounts& count : counts) {
    off += count.off;
    judged += count.judged;
  }
  return "the volume has no edge at " + std::to_string(off) + " of " + std::to_string(judged) +
         " places of its wall";
}

/// The parts of a branch that stay, in order; empty if none does.
std::vector<TrackedBranch> partsWithEdges(const TrackedBranch& branch,
                                          const std::vector<EdgeCounts>& counts) {
  std::vector<TrackedBranch> parts;
  for (const Stretch& stretch : stretchesWithEdges(branch.nodes, counts)) {
    TrackedBranch part = branch;
    if (stretch.end < branch.nodes.size()) part.stopReason = formats::StopReason::NoValidCylinder;
    if (stretch.first > 0) part.startReason = formats::StopReason::NoValidCylinder;
    keepStretch(part, stretch.first, stretch.end);
    const auto fitted = std::count_if(part.nodes.begin(), part.nodes.end(), isFitted);
    if (static_cast<std::size_t>(fitted) >= kFewestFitted) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

std::vector<std::vector<TrackedBranch>> takeWithoutEdges(const TrackContext& context,
                                                         TrackedTree& tree) {
  const WallEvidence evidence(context, tree);
  std::vector<std::vector<EdgeCounts>> counts(tree.branches.size());
  tbb::parallel_for(tree.known, tree.branches.size(), [&](std::size_t i) {
    if (!tree.isVessel(i) || tree.branches[i].nodes.empty()) return;
    context.progress.check();
    counts[i] = evidence.along(tree.branches[i], i);
  });
  std::vector<std::vector<TrackedBranch>> further(tree.branches.size());
  for (std::size_t i = tree.known; i < further.size(); ++i) {
    if (counts[i].empty()) continue;
    TrackedBranch& branch = tree.branches[i];
    std::vector<TrackedBranch> parts = partsWithEdges(branch, counts[i]);
    if (parts.empty()) {
      branch.failure = failureText(counts[i]);
      branch.nodes.clear();
      continue;
    }
    branch = std::move(parts[0]);
    parts.erase(parts.begin());
    further[i] = std::move(parts);
  }
  return further;
}

}  // namespace lumen::convert
