// SPDX-License-Identifier: Apache-2.0
// Growing one branch of a random tree: a smooth, tortuous curve that keeps clear of the others.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/random.h"
#include "converters/stages/phantom/design.h"

namespace lumen::convert {

/// The branches that are already there, as balls along their axes.
class GrownBranches {
public:
  /// `gap`: the clearance between walls that grow() keeps, mm. `low`, `high`: the box, mm, that
  /// balls stay in.
  GrownBranches(double gap, const Eigen::Vector3d& low, const Eigen::Vector3d& high)
      : m_gap(gap), m_low(low), m_high(high) {}

  void add(const Path& path, int branch);

  struct Nearest {
    double clearance =
        std::numeric_limits<double>::infinity();     ///< mm between surfaces; negative: overlap
    Eigen::Vector3d away = Eigen::Vector3d::Zero();  ///< unit, from that surface to the ball
  };
  /// The ball nearest to that of `radius` at `point` among the branches other than `except`.
  [[nodiscard]] Nearest nearestBut(int except, const Eigen::Vector3d& point, double radius) const;
  /// The ball nearest to that of `radius` at `point` among the balls of `branch` only.
  [[nodiscard]] Nearest nearestOnBranch(int branch, const Eigen::Vector3d& point,
                                        double radius) const;
  /// How far the ball lies within the box, mm; negative if it sticks out.
  [[nodiscard]] double depthInBox(const Eigen::Vector3d& point, double radius) const;

  [[nodiscard]] double gap() const { return m_gap; }
  [[nodiscard]] const Eigen::Vector3d& low() const { return m_low; }
  [[nodiscard]] const Eigen::Vector3d& high() const { return m_high; }

private:
  template <class Accept>
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& point, double radius, Accept accept) const;

  struct BranchBall {
    Eigen::Vector3d centre;
    double radius;
    int branch;
  };
  double m_gap;
  Eigen::Vector3d m_low, m_high;
  std::vector<BranchBall> m_balls;
};

/// Lengths in mm.
struct GrowthRequest {
  int parent = -1;  ///< branch that the start lies in, whose neighbourhood is left over
                    ///< `freeLength`; -1: none
  Eigen::Vector3d start, direction, target;
  double startRadius = 0, endRadius = 0;  ///< linear in the arc length in between
  double length = 0;
  double straight = 0;    ///< arc length without a bend at the start
  double freeLength = 0;  ///< by this arc length the parent's wall must be `gap` away
  double tortuosity =
      0.5;  ///< root mean square of the wandering curvature, as a share of the strongest one
};

/// The smallest radius of curvature of a branch of this radius, mm.
double tightestBend(double radius);

/// A curve from the request, walked in steps of `step` mm with a curvature that wanders as an
/// Ornstein-Uhlenbeck process, leans towards the target, and turns away from walls and the box. It
/// ends early before it would come closer than the gap to another branch or to itself, or leave the
/// box.
Path grow(const GrowthRequest& request, const GrownBranches& grown, double step, Random& random);

}  // namespace lumen::convert
