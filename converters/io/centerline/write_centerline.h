// SPDX-License-Identifier: Apache-2.0
// The tree of a case as centerlines for other programs: centres and radii, mm, LPS. Files omit
// non-circular sections, wall points and models, and trees omit links. Equal trees give equal bytes.
#pragma once

#include <string>

#include "formats/case/case.h"

namespace lumen::convert {

/// SWC: a point for each node, its id the node's index and one more. Types: 5 where vessels fork, 6
/// at ends, 0 elsewhere. Comments state unit and axes, and the label of each branch with the id of
/// its first point.
std::string encodeSwc(const formats::CenterlineTree& tree);

/// TubeTK: a scene of one tube (of the subtype Vessel) for each branch; ParentID and ParentPoint
/// state its attachment.
std::string encodeTre(const formats::CenterlineTree& tree);

/// Lines of VTK with VMTK's arrays: MaximumInscribedSphereRadius and Branch (index of the branch)
/// on points; CenterlineIds, TractIds, GroupIds and Blanking, as vmtkbranchextractor computes them,
/// on lines. A centerline is the path from a root to a tip, cut into tracts. Edges that leave a
/// node where vessels fork are blanked as long as they stay in that node's ball, and form one
/// group; the runs in between are groups of their own. Lines share points.
std::string encodeVtpCenterline(const formats::CenterlineTree& tree);

/// Slicer Markups: a curve for each branch, with the measurement "Radius". A child's curve begins
/// on its parent's axis.
std::string encodeCurves(const formats::CenterlineTree& tree);

// Networks, which hold the links that close loops, too. Pieces run from root, fork or tip to the next.

/// VessMorphoVis: vertices and strands. A comment states unit and axes.
std::string encodeVmv(const formats::CenterlineTree& tree);

/// GraphML, with a node for each of the tree's: X, Y, Z and radius, as VesselVio reads the centerlines of
/// a graph; unit and space of the graph.
std::string encodeGraphml(const formats::CenterlineTree& tree);

/// A spatial graph of Amira, text: the radius is its thickness.
std::string encodeSpatialGraph(const formats::CenterlineTree& tree);

/// Slicer Markups: a curve for one branch, which has a node, with the measurement "Radius".
std::string encodeCurve(const formats::CenterlineTree& tree, const formats::Branch& branch);

/// The value of "@schema" in a Slicer Markups file.
inline constexpr const char* kMarkupsSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
    "Schema/markups-schema-v1.0.3.json#";

}  // namespace lumen::convert
