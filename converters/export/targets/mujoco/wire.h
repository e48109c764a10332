// SPDX-License-Identifier: Apache-2.0
// The guidewire of a scene of MuJoCo: a chain of rigid links with springs between them, in SI
// units.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/mesh/surface_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A rod of one material, with the values that integrate its chain. Sources of the material:
/// docs/sofa.md.
struct Wire {
  double radius = 0.18e-3;  ///< m: 0.014 inches
  double modulus = 1e9;     ///< Pa, in bending: a cable has one, here that of the soft tip
  double poisson = 0.33;
  double density = 6450;  ///< kg/m^3
  double link = 1e-3;     ///< m; the chord of a bend of 3 mm radius leaves it by 0.04 mm
  int links = 0;

  [[nodiscard]] double length() const { return link * links; }
  [[nodiscard]] double mass() const;
  [[nodiscard]] double shearModulus() const { return modulus / (2 + 2 * poisson); }
  /// N m / rad, of the joint between two links: E I / link.
  [[nodiscard]] double jointStiffness() const;
  /// kg m^2. A link of a millimetre swings in microseconds. Inertia against bending, not against
  /// motion, slows that down to a rate that a time step can follow, and leaves slower motions as
  /// they are.
  [[nodiscard]] double armature() const;
  /// N m s / rad: damps that swing almost critically.
  [[nodiscard]] double damping() const;
};

/// s
constexpr double kMujocoStep = 1e-3;

/// Model of a wire's bending in a scene.
enum class WireSprings { Plugin, Joints };

/// The wire and its holder, as elements of <worldbody>: a straight channel that ends at `tip` and
/// looks along `direction`, and in it the wire, which ends there. m, in the scene's frame.
std::string wireBodies(const Wire& wire, const Eigen::Vector3d& tip,
                       const Eigen::Vector3d& direction, WireSprings springs);

/// The wire's <actuator>, and <keyframe> with `keys` after its own.
std::string wireControls(const Wire& wire, const std::string& keys);

// The walls that an instrument can touch.

/// The triangles of a surface of which a corner belongs to a node that is no farther than `length`,
/// mm, from `node` along the tree and its links. All of them if the surface does not know its
/// nodes.
SurfaceMesh wallsInReach(SurfaceMesh mesh, const formats::CenterlineTree& tree, std::uint32_t node,
                         double length);

/// Length, m, of a straight wire that lies free behind its tip, at most `length`: none of it in a
/// box around a piece, where it would be in the solid, or nearer than `radius` to it. All in
/// metres; triangles look out of the solid.
double freeBehind(const std::vector<SurfaceMesh>& pieces, const Eigen::Vector3d& tip,
                  const Eigen::Vector3d& direction, double length, double radius);

}  // namespace lumen::convert
