// SPDX-License-Identifier: Apache-2.0
// One branch: estimation and prediction steps in turn (thesis algorithm 1), and where to begin.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/common/progress.h"
#include "converters/common/random.h"
#include "converters/seeds/seeds.h"
#include "converters/tracking/cylinder.h"
#include "converters/tracking/rays.h"
#include "converters/tracking/track_options.h"
#include "converters/tracking/tracked_branch.h"

namespace lumen::convert {

/// Half the sum of the two middle values, or the middle one; of a non-empty list.
double median(std::vector<double> values);

/// Where a vessel goes from its first point (unit, LPS), as far as the user said.
std::optional<Eigen::Vector3d> directionOf(const SeedBranch& seed);

/// Not thread-safe: one per thread.
class BranchTracker {
public:
  /// `noiseFloor`: see noise_floor.h.
  BranchTracker(const BsplineVolume& volume, const TrackOptions& options, double noiseFloor,
                const Progress& progress);

  /// Tracks one vessel. `parent` may be null; `finished` are the branches that end this one when it
  /// runs into them.
  TrackedBranch track(const SeedBranch& seed, const TrackedBranch* parent,
                      std::span<const TrackedBranch* const> finished, Random random);

  /// Wall points of an aneurysm from its ordered centres (thesis section 3.7).
  TrackedBranch capture(const SeedBranch& seed, const TrackedBranch* parent);

private:
  static constexpr int kTrialSteps = 4;  ///< that a start must lead to
  struct Guess {
    Eigen::Vector3d centre, direction;
    double radius = 0;
    bool smooth = false;  ///< `direction` is that of a path: sharp turns are unlikely
    double slack = std::numeric_limits<double>::infinity();  ///< how far the centre may move along
                                                             ///< the axis, mm
  };
  std::optional<TrackedNode> fitNode(const Guess& guess, double minRate, Random& random);
  void follow(TrackedBranch& branch, std::span<const TrackedBranch* const> finished,
              Random& random);
  /// Means over the last nodes of a track.
  struct Recent {
    double inlierRate = 0, strength = 0, radius = 0;
  };
  static Recent recent(const std::vector<TrackedNode>& nodes);
  bool isNoise(const TrackedNode& node) const;
  bool isSwollen(const std::vector<TrackedNode>& nodes, const TrackedNode& next) const;
  int stepsFrom(const TrackedNode& start, Random& random);
  Guess predict(const TrackedNode& from, double steps, const Eigen::Vector3d& direction) const;
  std::vector<TrackedNode> lookAhead(const std::vector<TrackedNode>& nodes, Random& random);
  bool recover(std::vector<TrackedNode>& nodes, std::size_t& longest, Random& random);
  std::optional<TrackedNode> startAt(const SeedPoint& point, const Eigen::Vector3d& direction,
                                     bool smooth, Random& random);
  std::optional<TrackedNode> startBeside(const TrackedBranch& parent,
                                         std::span<const Guess> guesses,
                                         std::span<const double> radii, Random& random);
  std::vector<TrackedNode> startChild(const SeedBranch& seed, const TrackedBranch& parent,
                                      int& parentNode, Random& random);
  std::vector<TrackedNode> trackBack(const TrackedNode& start, const TrackedBranch& goal,
                                     Random& random);
  bool passThrough(const SeedPoint& point, TrackedBranch& branch,
                   std::span<const TrackedBranch* const> finished, Random& random);
  void finishNode(TrackedNode& node, const Cylinder& cylinder);

  const BsplineVolume& m_volume;
  const TrackOptions& m_options;
  double m_noiseFloor;
  const Progress& m_progress;
  RayCaster m_rays;
  CylinderEstimator m_estimator;
  Candidates m_points;
  std::vector<std::size_t> m_inliers;
  double m_bestRate = 0;    ///< of the starts that were tried
  bool m_inParent = false;  ///< one of them was refused because it is the parent
};

}  // namespace lumen::convert
