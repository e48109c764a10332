// SPDX-License-Identifier: Apache-2.0
// Seeds and the branches that are tracked from them: out of a case, into a case, and remarks.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/tracking/cylinders/tracked_branch.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Seeds, and the branch that was tracked from each. Parents come before their children.
struct TrackedTree {
  std::vector<SeedBranch> seeds;
  std::vector<TrackedBranch> branches = {};  ///< in the order of the seeds
  /// The first branches, which a case has already: tracking adds to them, but does not change them.
  std::size_t known = 0;

  [[nodiscard]] bool isVessel(std::size_t i) const {
    return seeds[i].kind == formats::BranchKind::Vessel;
  }
};

/// All branches of a valid case, in its order, as known ones. Each seed has one point, at the first
/// node of its branch. Values that a case does not hold are 0: the strength of walls, and how far
/// points lie along the axis.
TrackedTree makeTrackedTree(const formats::Case& vesselCase);

/// Appends the new branches that have nodes, with their points, to a case that has points: in the
/// seeds' order, but every parent, which has nodes, before its children. The known branches are
/// those of the case. Arrays of rates, of origins and of systems, which are unknown for new nodes, are
/// continued; new nodes have no models.
void appendTracks(const TrackedTree& tree, formats::Case& target);

/// A case of the tree's branches alone.
formats::Case caseOfTracks(const TrackedTree& tree);

/// An end of a tracked vessel, and the reason for it.
struct TrackEnd {
  std::string label;
  bool isStart = false;  ///< the other end of a root that was tracked in both directions
  formats::StopReason reason = formats::StopReason::Unknown;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< mm, LPS
  /// least length, mm, for which the lumen is seen to continue from there; 0 if it ends
  double goesOn = 0;
};

/// Results of the seeds besides their branches.
struct TrackRemarks {
  std::vector<SeedFailure> failures;
  std::vector<SeedFailure> missedPoints;  ///< further points that tracked vessels do not reach
  std::vector<SeedFailure> unjoined;      ///< tracked vessels that are joined to no parent
  std::vector<TrackEnd> ends;             ///< ends of the tracked vessels, in the seeds' order
};

/// Remarks on the seeds behind the known ones.
TrackRemarks remarksOn(const TrackedTree& tree);

}  // namespace lumen::convert
