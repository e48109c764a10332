// SPDX-License-Identifier: Apache-2.0
// A surface cut into boxes, for programs that sample each mesh on a grid of fixed size.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "converters/export/shared/vessel_distance.h"
#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"
#include "formats/field/pose.h"

namespace lumen::convert {

/// A corner of a triangle, and the vessel's radius there, in the unit of the surface.
struct WallCorner {
  Eigen::Vector3d position;
  double radius = 0;
  std::uint32_t branch = 0;
};
using WallFacet = std::array<WallCorner, 3>;

/// The triangles of a surface with their corners.
std::vector<WallFacet> wallFacets(const SurfaceMesh& mesh);

/// Whether a piece may stay as it is for another reason than its size.
using PieceRule = std::function<bool(std::span<const WallFacet>)>;

/// Cuts a surface by planes across its axes until every piece fits into `cells` cells of `share` of
/// its least radius, or until it is of `kFewest` triangles; a
/// `rule`, if there is one, has to hold as well. Edges that a plane cuts are cut at the
/// same point on both sides. Planes avoid walls that run along them: beside such a wall a piece
/// would not hold the wall that is nearest. One piece if nothing needs cutting: the mesh itself. A
/// piece holds all of the surface in its box, so the side of its nearest triangle on which a point
/// of the box lies is the side of the surface on which it lies. Pieces state the branches and
/// systems of the surface.
std::vector<SurfaceMesh> cutIntoPieces(const SurfaceMesh& mesh, std::size_t cells, double share,
                                       const PieceRule& rule = {});

// Rigid bodies that carry the pieces of a wall while the motion of a case plays.

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
