// SPDX-License-Identifier: Apache-2.0
// Vessels of a tree that was found without a click: which of them continue one another, where blood
// comes in, and which branch goes on at a fork (docs/method.md, section 1.14).
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// The volume that a tree was found in.
struct Surrounding {
  std::function<bool(const Eigen::Vector3d&)> isLumen;   ///< a point, mm, LPS, lies in a vessel
  std::function<bool(const Eigen::Vector3d&)> isInside;  ///< it lies in the volume
};

/// Corrects the topology of a valid case without models. Measured nodes and walls stay; bridged nodes
/// follow their neighbours (smooth_axes.h).
///
/// - Two ends that face one another through the lumen, of like direction and width, are one vessel:
///   two that leave a third on both sides cross it, and are joined to one another instead, also where
///   that one bends and they touch it all along; a tip and a start, or two tips, are joined by a
///   bridge. A join that closes a loop becomes a link.
/// - Tips that overlap are one vessel (overlapping_ends.h), and a tip before the side of another joins
///   it (into_sides.h). Loops are cut where vessels only touch (rungs.h).
/// - Ends of two trees that face one another across a void are one vessel, too (across_voids.h).
/// - Each tree begins at its widest end that leaves the volume, or at its widest end if those that
///   leave are less than half as wide.
/// - At a fork the straightest, widest vessel keeps the branch. Vessels are named vessel-1 and so on,
///   in the order of trees by their nodes, aneurysms aneurysm-1 and so on; those stay on their nodes.
/// Returns the places at which two ends became one vessel, mm, LPS.
std::vector<Eigen::Vector3d> untangle(formats::Case& target, const Surrounding& around);

}  // namespace lumen::convert
