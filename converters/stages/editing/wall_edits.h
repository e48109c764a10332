// SPDX-License-Identifier: Apache-2.0
// Corrections of walls and of nodes by hand. All that edit.h states of its corrections holds for
// these, too. A node whose wall they change is marked as edited (formats/case/edited_walls.h), and
// no inlier rate speaks for it any more.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "converters/stages/editing/selection.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Gives the vessel another radius at `node`, mm, and carries the nodes of its branch within `reach`
/// mm along it: their radii and the distances of their wall points from the axis grow or shrink by
/// the same factor at the node, and by less and less, without a step, up to `reach`. Wall points of
/// an aneurysm move away from their nodes' centres.
Change widenAround(formats::Case& target, std::uint32_t node, double radius, double reach);

/// A stroke of the brush.
struct Stroke {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< where it begins, mm, LPS
  Eigen::Vector3d by = Eigen::Vector3d::Zero();  ///< mm, displacement of the wall there
  double radius = 0;                             ///< mm: points farther from `at` stay
};

/// Pushes or pulls the wall near `node`: wall points within the brush move with it, in full at its
/// middle and less and less, without a step, towards its rim. Only points of nodes that hang
/// together with `node` along the tree near by move, so a vessel that touches stays. None comes
/// nearer to the axis than a quarter of its distance. The radii of their nodes follow. Also throws
/// if the brush holds no wall point.
Change pushWall(formats::Case& target, std::uint32_t node, const Stroke& stroke);

/// Puts a node halfway between `node` and the next of its branch. It takes their wall points in the
/// middle half between them; without any it is bridged.
Change addNodeBehind(formats::Case& target, std::uint32_t node);

/// Deletes a node; its neighbours in the branch, of which there must be one, take its wall points,
/// and the one before it (the one behind the first) all that hangs on it. Throws for a node that
/// closes a loop.
Change deleteNode(formats::Case& target, std::uint32_t node);

}  // namespace lumen::convert
