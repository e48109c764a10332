// SPDX-License-Identifier: Apache-2.0
// Vessels of a tree that was found without a click: which of them continue one another, where blood
// comes in, and which branch goes on at a fork (docs/method.md, section 1.14).
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "converters/stages/editing/editable_case.h"
#include "converters/stages/editing/node_graph.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The volume that a tree was found in.
struct LumenInVolume {
  std::function<bool(const Eigen::Vector3d&)> isLumen;   ///< a point, mm, LPS, lies in a vessel
  std::function<bool(const Eigen::Vector3d&)> isInside;  ///< it lies in the volume
};

/// Corrects the topology of a valid case without models. Measured nodes and walls stay; bridged nodes
/// follow their neighbours (smoothAxes()).
///
/// - Two ends that face one another through the lumen, of like direction and width, are one vessel:
///   two that leave a third on both sides cross it, and are joined to one another instead, also where
///   that one bends and they touch it all along; a tip and a start, or two tips, are joined by a
///   bridge. A join that closes a loop becomes a link.
/// - Tips that overlap are one vessel (joinOverlappingEnds()), and a tip before the side of another
///   joins it (joinIntoSides()). Loops are cut where vessels only touch (cutFalseConnections()).
/// - Two tracks in one lumen become one (mergeDoubledTracks()).
/// - Ends of two trees that face one another across a void are one vessel, too (joinAcrossVoids()).
/// - Each tree begins at its widest end that leaves the volume, or at its widest end if those that
///   leave are less than half as wide.
/// - At a fork the straightest, widest vessel keeps the branch. Vessels are named vessel-1 and so on,
///   in the order of trees by their nodes, aneurysms aneurysm-1 and so on; those stay on their nodes.
/// Returns the places at which two ends became one vessel, mm, LPS.
std::vector<Eigen::Vector3d> correctTopology(formats::Case& target, const LumenInVolume& around);

// Vessels that go on behind a stretch without contrast (docs/method.md, section 1.14).

/// Joins trees of a graph by bridges where an end of one lies ahead of an end of another, faces it and
/// is as wide, although no lumen is seen between them: blood that swirls or flows along the slices
/// leaves such voids in magnetic resonance, a clip or a stent beside a vessel in other volumes. Both
/// trees must be longer than the gap. Directions of edges are stale afterwards. Returns the places of
/// the joined ends, one for each pair, mm.
std::vector<Eigen::Vector3d> joinAcrossVoids(NodeGraph& graph);

// Vessels that end just before the side of another, which they join (docs/method.md, section 1.14).

/// Joins ends of a graph to the vessel that lies ahead of them, by a bridge to its axis, or by a link
/// behind a bridge where that closes a loop. A skeleton cuts each loop at one place; if that is near
/// a fork, the short rest beyond the cut is taken for a bump of the wall there. `isOpen`: whether
/// only lumen lies between two points, mm, LPS. Directions of edges are stale afterwards. Returns the
/// places of the joined ends, mm, LPS.
std::vector<Eigen::Vector3d> joinIntoSides(
    NodeGraph& graph,
    const std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)>& isOpen);

// Two tracks that entered the same stretch of a vessel from both sides (docs/method.md, section 1.14).

/// Joins pairs of tips that have passed one another within one vessel: the centre of each lies in the
/// lumen of the other's vessel, which is of like width and leads the other way. The stretch that both
/// have is kept of the one that has more measured nodes there; a stretch that a branch or an aneurysm
/// leaves stays as it is. Directions of edges are stale afterwards. Returns the places of the joined
/// ends, one for each pair, mm, LPS.
std::vector<Eigen::Vector3d> joinOverlappingEnds(NodeGraph& graph);

// Two tracks in one lumen (docs/method.md, section 1.14).

/// Makes one vessel of two that run in one lumen beyond their joint: nodes of the one, within half a
/// radius of the other's axis, that run along it, or end there. The vessel with more measured nodes keeps the
/// stretch, and all that hangs on the other's hangs on it; a loop that this closes becomes a link if it is longer than
/// eight times both radii. Vessels that cross, and two that end there, are left as they are. The graph is directed; directions of edges are
/// stale afterwards. Returns the places at which such stretches began, mm, LPS.
std::vector<Eigen::Vector3d> mergeDoubledTracks(NodeGraph& graph);

// Places at which two vessels only touch, found from the loops that they close (docs/method.md,
// section 1.14).

/// Cuts loops of a graph where two vessels touch instead of at the links that hold them together. A
/// *false connection* is a path between two nodes along which two lumens meet, and at both of which
/// another vessel goes on: the vessels pass one another there. A link on a loop that has a false
/// connection becomes an edge, and the connection is cut; other links stay, as those of communicating
/// arteries. Directions of edges are stale afterwards.
void cutFalseConnections(NodeGraph& graph);

// Axes through the places where no wall was measured: forks, and where vessels touch (docs/method.md,
// section 1.14).

/// Moves the bridged nodes of the vessels of an editable case, and the places at which vessels leave
/// their parents; measured nodes stay.
///
/// - Bridged nodes between two measured ones of a branch lie on the curve along the directions of
///   both, unless that leads farther than a radius from where they were.
/// - A vessel leaves its parent, within twice the lesser radius of where it did, where the path from
///   axis to axis turns least; each radius of that path counts as a quarter radian. Its bridged
///   nodes before the first measured one lie on that path, outside of the parent's core.
void smoothAxes(EditableCase& edited);

}  // namespace lumen::convert
