// SPDX-License-Identifier: Apache-2.0
// One tracked vessel before it becomes a case.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"
#include "formats/case/node_origin.h"

namespace lumen::convert {

/// A place nearer to a vessel's axis than this share of its radius is in the vessel's core: it
/// belongs to that vessel.
constexpr double kCore = 0.5;
/// Distance from one node along a course to the next, in radii.
constexpr double kSpacingRadii = 0.5;
/// Cosine of 45 degrees, the largest angle between the directions of one vessel at neighbouring
/// places, and between the direction of an end and the way to what it leads to.
constexpr double kAheadCosine = 0.7;
/// Straight distances: a longer way leads along other vessels.
constexpr double kLongestDetour = 2.5;

/// A node with its wall points (mm, LPS).
struct TrackedNode {
  formats::NodeOrigin origin = formats::NodeOrigin::Measured;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitZ();
  double radius = 0, height = 0, inlierRate = 0;
  double strength = 0;         ///< median fall of intensity at the points, voxel units per mm
  double meanSquareAlong = 0;  ///< mean over the inliers, along the axis from the centre, mm^2
  std::vector<formats::Vec3f> points;
};

struct TrackedBranch {
  std::vector<TrackedNode> nodes;  ///< in order, away from the parent; empty if nothing was tracked
  std::size_t clickNode = 0;       ///< the node that was fitted at the seed's first point
  formats::StopReason stopReason = formats::StopReason::Unknown;  ///< at its last node
  /// stop reason at its first node, if it was tracked in both directions from a click
  formats::StopReason startReason = formats::StopReason::Unknown;
  double goesOn = 0;       ///< mm for which the lumen is seen to continue beyond the last node
  double startGoesOn = 0;  ///< mm for which it is seen to continue beyond the first node
  std::string failure;     ///< reason why nothing was tracked
  std::string unjoined;    ///< reason why it is not joined to its parent, if it should be
  std::vector<std::string> missedPoints;  ///< a sentence for each further click not reached
  int parentBranch = -1;                  ///< position in the seeds' order; -1: a root
  int parentNode = -1;                    ///< within that branch
  bool isTail = false;                    ///< it has nodes that its parent had tracked
  int trackedBy = -1;  ///< if it has no nodes: the branch in which its click lies
};

/// The reason why a seed on a vessel that is tracked already starts no track.
constexpr const char* kTrackedAlready =
    "the seed leads into a vessel that another seed has tracked; one seed is enough for each";

/// A node with the opposite direction.
TrackedNode reversed(TrackedNode node);

/// True if the line from `node` to `next` leads ahead in the directions of both.
bool isAhead(const TrackedNode& node, const TrackedNode& next);

/// Whether to drop each node, so that each that is left lies ahead of the one before: cylinders may
/// slide along a vessel. Those that are left have the greatest sum of inlier rates. Nodes that are
/// null are left out.
std::vector<bool> turnedBack(std::span<const TrackedNode* const> nodes);

/// Reverses the order and the direction of nodes.
void reverseTrack(std::vector<TrackedNode>& nodes);

/// Makes a branch run from its last node to its first.
void turnRound(TrackedBranch& branch);

/// Drops the nodes of a branch that turn back.
void dropTurnedBack(TrackedBranch& branch);

/// Drops one of two nodes that are nearer to one another than a quarter of the radius, the one with
/// the lower inlier rate: cylinders of an end have their wall on one side, and slide together.
void dropCrowded(TrackedBranch& branch);

/// Drops the last nodes of a branch that narrow to less than six tenths within a radius: cylinders
/// in the dome in which the lumen of a vessel ends.
void dropDome(TrackedBranch& branch);

/// The sum of the distances between consecutive nodes, mm.
double measureLength(std::span<const TrackedNode> nodes);

/// A place on a chain of nodes.
struct ChainPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double radius = 0;     ///< mm, interpolated
  double distance = 0;   ///< mm
  std::size_t node = 0;  ///< the nearer end of the closest segment
};
/// The place on a chain that is closest to a point; at infinite distance for an empty chain.
ChainPoint closestOnChain(std::span<const TrackedNode> chain, const Eigen::Vector3d& point);

/// True if half of a node's lumen or its axis lies in the core of one of `branches`: within half of
/// that branch's radius from its axis or, if the node is narrower, a whole radius less half of the
/// node's own.
bool inCore(std::span<const TrackedBranch* const> branches, const TrackedNode& node);

}  // namespace lumen::convert
