// SPDX-License-Identifier: Apache-2.0
// Rigid bodies that carry the pieces of a wall while the motion of a case plays.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "converters/export/shared/vessel_distance.h"
#include "converters/export/targets/mujoco/wall_pieces.h"
#include "formats/case/case.h"
#include "formats/field/pose.h"

namespace lumen::convert {

/// A rigid body at the times of a motion: it takes a point X at rest to place + turn (X - centre).
/// m, LPS.
struct RidingBody {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> place;
  std::vector<Eigen::Quaterniond> turn;
  /// radii: greatest distance of a corner from where the motion has it, at these times
  double misfit = 0;
};

/// The motion of a case, as it takes points of the wall along: by the weights of the nodes that
/// answer at them.
class WallBodies {
public:
  /// `source` has models and a motion. Throws as openModels().
  explicit WallBodies(const formats::Case& source);

  /// The body that fits a piece best at each time (S. Umeyama, Least-squares estimation of
  /// transformation parameters between two point patterns, 1991). Positions in m, LPS.
  [[nodiscard]] RidingBody carrying(std::span<const WallFacet> piece) const;
  [[nodiscard]] RidingBody carrying(const SurfaceMesh& piece) const;
  /// The body of a place, m, LPS, which turns as its node does.
  [[nodiscard]] RidingBody carrying(const Eigen::Vector3d& place) const;

  /// Keyframes of MuJoCo, one for each time of the motion, which place these bodies.
  [[nodiscard]] std::string keyframes(std::span<const RidingBody> bodies) const;

private:
  [[nodiscard]] std::vector<Eigen::Vector3d> wayOf(const Eigen::Vector3d& position,
                                                   std::uint32_t& node) const;

  const formats::CenterlineTree& m_tree;
  OwnedModel m_model;
  std::vector<double> m_times;                        ///< s
  std::vector<std::vector<field::NodePose>> m_poses;  ///< of all nodes, time by time; mm
};

}  // namespace lumen::convert
