// SPDX-License-Identifier: Apache-2.0
// Corrections of a case by hand (docs/method.md, section 11). Each takes a valid case and leaves one: branches
// contiguous, parents before their children, links, wall points, models and node arrays with their
// nodes; chunks of others that may be wrong now are dropped, and the "edit" step says what was done.
// Branches and nodes are given by index; those of the case afterwards are in `before` of the result.
// Each throws Error(InvalidInput) with a sentence for people if an argument is none of the case or
// breaks a rule, and then the case is as it was. Costs O(n) for n nodes and their points and blobs.
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "converters/stages/editing/change.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// What becomes of the branches that hang on one that is deleted, directly or not.
enum class Hanging : std::uint8_t {
  Stay,  ///< those that hang on it directly become trees of their own: nothing goes that was not named
  Go     ///< they are deleted with it
};
/// At least one branch must stay.
Change deleteBranch(formats::Case& target, std::uint32_t branch, Hanging hanging = Hanging::Stay);

/// What becomes of a branch from a cut on.
enum class Rest : std::uint8_t {
  OwnTree,  ///< the edge at the cut goes, and its walls close when it is fitted
  Child     ///< it hangs where it was cut off: two names, one lumen, and no wall changes
};
/// Ends a branch before `node`, which is not its first. From there on it is a branch of its own, of
/// the same kind, directly behind; `label` empty: the label and the first free number from 2 on.
Change cutBefore(formats::Case& target, std::uint32_t node, Rest rest = Rest::OwnTree,
                 const std::string& label = {});

/// Hangs a branch by its first node on `node`, with all that hangs on it, whatever it hung on before: a
/// bridge to that goes. The way there is bridged by nodes along the straight line, half a radius apart,
/// without wall points and marked as bridged. `node` is not of the branch, nor of one that hangs on it.
Change joinBranch(formats::Case& target, std::uint32_t branch, std::uint32_t node);

/// Makes a branch the rest of the one whose last node it hangs on, of the same kind.
Change mergeIntoParent(formats::Case& target, std::uint32_t branch);

/// Turns a branch round: its last node is its first. If it hung on a node, it lets go of it, and is a
/// tree of its own. What hangs on the branch stays where it is.
Change reverseBranch(formats::Case& target, std::uint32_t branch);

/// Makes the last node of a branch the root of its tree, and turns round what lies between it and the
/// root so far. A branch on the way that goes on past where the way leaves it is divided there: the
/// longer part keeps the label. No edge comes or goes, so no wall changes.
Change makeRoot(formats::Case& target, std::uint32_t branch);

Change setKind(formats::Case& target, std::uint32_t branch, formats::BranchKind kind);

/// `label`: not that of another branch, not empty, at most 255 bytes of UTF-8 without control characters.
Change renameBranch(formats::Case& target, std::uint32_t branch, const std::string& label);

/// Moves a node and says how wide the vessel is there, mm, LPS. In a vessel, its section is then that of
/// a circle: the node is marked as given and loses its wall points, and so do its neighbours theirs that
/// lie between the planes halfway to them, before and now. An aneurysm keeps its wall points. The node's
/// direction becomes that between its neighbours in the branch.
Change moveNode(formats::Case& target, std::uint32_t node, const Eigen::Vector3d& position,
                double radius);

}  // namespace lumen::convert
