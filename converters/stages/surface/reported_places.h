// SPDX-License-Identifier: Apache-2.0
// Overlaps of vessels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/surface/case_surface.h"
#include "converters/stages/surface/separated_field.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Two vessels that overlap, so that their walls were moved apart.
struct Overlap {
  std::uint32_t branch = 0, other = 0;  ///< branches of the tree, the lesser first
  double depth = 0;                     ///< greatest distance that a wall was moved inwards, mm
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< place of that depth, mm, LPS
};

/// The pairs of branches whose walls the surface keeps apart although the field's would overlap,
/// the deepest first.
std::vector<Overlap> findOverlaps(const CaseSurface& surface, const SeparatedField& field);

// Stretches of vessels that a surface leaves out.

/// A sentence for each stretch of a branch, longer than four radii, around which the surface has no
/// wall: no vertex whose cursor is at one of its nodes, and none of any vessel within two radii of
/// its middle. Places in mm, LPS. O(v + n) for v vertices and n nodes, and O(v) for each stretch.
std::vector<std::string> stretchesWithoutWall(const CaseSurface& surface,
                                              const formats::CenterlineTree& tree);

}  // namespace lumen::convert
