// SPDX-License-Identifier: Apache-2.0
// Corrections of a case by hand (docs/method.md, section 11). Each takes a valid case and leaves a
// valid one: branches contiguous, parents before their children, links, wall points, models and
// node arrays with their nodes. Chunks of others that may be wrong now are dropped, and the "edit"
// step records the edit. Branches and nodes are given by index; `before` of the result maps the
// indices afterwards to these. Each throws Error(InvalidInput) with a sentence for people if an
// argument is not of the case or breaks a rule, and then the case is as it was. Costs O(n) for n
// nodes and their points and blobs.
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "converters/stages/editing/selection.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Treatment of the descendants of a branch that is deleted.
enum class Hanging : std::uint8_t {
  Stay,  ///< its children become trees of their own: only the named branch goes
  Go     ///< they are deleted with it
};
/// Deletes a branch, with or without its descendants. At least one branch must stay.
Change deleteBranch(formats::Case& target, std::uint32_t branch, Hanging hanging = Hanging::Stay);

/// Treatment of the part of a branch behind a cut.
enum class Rest : std::uint8_t {
  OwnTree,  ///< the edge at the cut is removed, and its walls close in the next fit
  Child     ///< it is joined where it was cut off: two names, one lumen, and no wall changes
};
/// Ends a branch before `node`, which is not its first. The nodes from there on become a branch of
/// the same kind, directly behind; `label` empty: the label and the first free number from 2 on, or of an
/// automatic name the next piece (geometry/automatic_names.h), behind which the others are renumbered.
Change cutBefore(formats::Case& target, std::uint32_t node, Rest rest = Rest::OwnTree,
                 const std::string& label = {});

/// Joins a branch by its first node to `node`, with all its descendants. Any former bridge to a
/// parent is removed. Nodes along the straight line, half a radius apart, without wall points and
/// marked as bridged, lead to `node`. `node` belongs neither to the branch nor to a descendant of
/// it.
Change joinBranch(formats::Case& target, std::uint32_t branch, std::uint32_t node);

/// Appends a branch to the one whose last node it is joined to, of the same kind.
Change mergeIntoParent(formats::Case& target, std::uint32_t branch);

/// Reverses a branch: its last node becomes its first. A branch that was joined to a node is
/// detached, and becomes a tree of its own. Branches joined to it stay where they are.
Change reverseBranch(formats::Case& target, std::uint32_t branch);

/// Makes the last node of a branch the root of its tree, and reverses the path between it and the
/// former root. A branch that continues beyond the place where this path leaves it is divided
/// there: the longer part keeps the label. No edge is added or removed, so no wall changes.
Change makeRoot(formats::Case& target, std::uint32_t branch);

Change setKind(formats::Case& target, std::uint32_t branch, formats::BranchKind kind);

/// Sets the label of a branch: unique, not empty, at most 255 bytes of UTF-8 without control
/// characters.
Change renameBranch(formats::Case& target, std::uint32_t branch, const std::string& label);

/// Moves a node and sets the radius of the vessel there, mm, LPS. In a vessel, its section becomes
/// a circle: the node is marked as given and loses its wall points, and its neighbours lose those
/// that lie between the planes halfway to them, before and now. An aneurysm keeps its wall points.
/// The node's direction becomes that between its neighbours in the branch.
Change moveNode(formats::Case& target, std::uint32_t node, const Eigen::Vector3d& position,
                double radius);

}  // namespace lumen::convert
