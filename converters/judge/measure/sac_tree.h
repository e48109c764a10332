// SPDX-License-Identifier: Apache-2.0
// The aneurysms of a tree, and the vessels that they sit on.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// A vessel that leads to or from a sac, seen from the sac.
struct SacVessel {
  std::uint32_t node = 0;  ///< where it is measured first: beyond the neck
  /// Unit, from the sac along the vessel.
  Eigen::Vector3d away = Eigen::Vector3d::Zero();
  double diameter = 0;  ///< mm: mean of two places, 1.5 diameters apart
};

/// An aneurysm with its lobes: branches that hang on one another.
struct SacTree {
  std::vector<std::uint32_t> branches;               ///< the one that hangs on a vessel first
  std::vector<std::uint32_t> nodes;                  ///< their nodes, ascending
  std::int32_t attachment = formats::kNoParent;      ///< node of the vessel that it hangs on
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mean of the nodes' balls by volume, mm
  double radius = 0;                                 ///< of the greatest ball, mm
  std::uint32_t widest = 0;                          ///< the node of the greatest ball
};

/// All aneurysms, in the order of their first branches.
std::vector<SacTree> findSacs(const formats::CenterlineTree& tree);

/// The vessels at the neck of a sac that hangs on one, each at the first node that lies farther than
/// `clearance` mm along the tree from the sac's attachment; the one towards the root first, if there
/// is one. Vessels that end before are left out.
std::vector<SacVessel> vesselsAtNeck(const formats::CenterlineTree& tree, const SacTree& sac,
                                     double clearance);

}  // namespace lumen::convert
