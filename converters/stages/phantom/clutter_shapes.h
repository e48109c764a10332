// SPDX-License-Identifier: Apache-2.0
// Shapes of clutter beside the vessels of a design. Lengths in mm, places in LPS.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "converters/base/random.h"
#include "converters/stages/phantom/design.h"

namespace lumen::convert {

/// A node of a vessel, and the nodes of its branch around it.
struct BranchStretch {
  std::uint32_t middle = 0;
  std::uint32_t first = 0, last = 0;  ///< within the branch of `middle`
};

/// A random node in the middle half of a branch that is no aneurysm, no narrower than half of the
/// nodes are, with the nodes of its branch that lie within `reach` radii of it along the branch.
/// None for a design without such a branch.
std::optional<BranchStretch> pickStretch(const formats::CenterlineTree& tree, double reach,
                                         Random& random);

/// A curved slab: part of a shell around a centre.
class Bone {
public:
  /// Its inner face passes the wall of the vessel at `stretch` at 0 to half a radius, and bends around it.
  Bone(const formats::CenterlineTree& tree, const BranchStretch& stretch, double extent,
       double voxel, Random& random);
  /// Intensity at a place, as a share of the vessels' contrast; 0 outside.
  [[nodiscard]] double at(const Eigen::Vector3d& place) const;

private:
  [[nodiscard]] double spongy(const Eigen::Vector3d& place) const;

  Eigen::Vector3d m_centre, m_axis;
  double m_bend = 0;       // radius of the inner face
  double m_thickness = 0;  // between the faces
  double m_half = 0;       // along the inner face, from its middle to the rim
  double m_cortex = 0;
  double m_pore = 0;  // wavelength of the spongy inside
  double m_voxel = 0;
};

/// A metal ball and its streaks.
class Streaks {
public:
  /// The ball lies three radii off the wall of the vessel at `stretch`.
  Streaks(const formats::CenterlineTree& tree, const BranchStretch& stretch, double voxel,
          Random& random);
  /// Intensity of the ball; 0 outside.
  [[nodiscard]] double ball(const Eigen::Vector3d& place) const;
  /// The streaks' share at a place, which is added to everything, and is negative in dark ones.
  [[nodiscard]] double streak(const Eigen::Vector3d& place) const;

private:
  Eigen::Vector3d m_centre;
  double m_radius = 0, m_voxel = 0, m_phase = 0, m_phase2 = 0;
};

/// A tube along the vessel of `stretch`, 1.3 times as wide, that winds half around it at a tenth of
/// the sum of both radii off its wall.
Design veinAlong(const formats::CenterlineTree& tree, const BranchStretch& stretch, double voxel,
                 Random& random);

/// Wires in the wall of `stretch`: four helices in either direction, at 45 degrees.
Design stentIn(const formats::CenterlineTree& tree, const BranchStretch& stretch, double voxel,
               Random& random);

}  // namespace lumen::convert
