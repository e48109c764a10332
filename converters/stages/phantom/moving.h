// SPDX-License-Identifier: Apache-2.0
// Motions of phantoms that are known exactly: a point of the tissue at rest is carried to another place,
// and a node's pose is that of the tissue around its centre.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/geometry/box.h"
#include "formats/case/case.h"

namespace lumen::convert {

enum class PhantomMotion {
  None,
  Heart,  ///< shortens and twists about an axis along z, as the left ventricle does
  Breath  ///< shifts towards the feet, less so there
};

const std::map<std::string, PhantomMotion>& phantomMotionByName();

/// Seconds of a cycle: 0.8 for the heart, 4 for a breath.
double periodOf(PhantomMotion motion);

/// A motion of the tissue in a box.
class MovingTissue {
public:
  /// `rest`: box around the vessels at rest, mm. `motion` is not None.
  MovingTissue(PhantomMotion motion, const Box3d& rest);

  /// Place of a point at a share of the cycle, 0 to 1, mm; the point itself at 0.
  [[nodiscard]] Eigen::Vector3d place(const Eigen::Vector3d& point, double phase) const;
  /// The pose of a node: the rotation is that of the polar decomposition of the tissue's deformation
  /// around its centre; the factor is that of the vessel, which widens and narrows by some hundredths.
  [[nodiscard]] formats::Pose pose(const Eigen::Vector3d& centre, double phase) const;

private:
  PhantomMotion m_motion;
  Box3d m_rest;
};

/// The poses of all nodes at `phases` times, evenly over a cycle from the rest on.
formats::Motion motionOfTissue(const formats::CenterlineTree& tree, const MovingTissue& tissue,
                               double period, std::size_t phases);

}  // namespace lumen::convert
