// SPDX-License-Identifier: Apache-2.0
// The tree of a case as centerlines for other programs: centres and radii, mm, LPS. Sections that are
// not round, wall points, models and links are not in them. Equal trees give equal bytes.
#pragma once

#include <string>

#include "formats/case/case.h"

namespace lumen::convert {

/// SWC: a point for each node, its id the node's index and one more. Types: 5 where vessels fork, 6
/// at ends, 0 elsewhere. Comments say unit and axes, and the label of each branch with the id of its
/// first point.
std::string encodeSwc(const formats::CenterlineTree& tree);

/// TubeTK: a scene of one tube (of the subtype Vessel) for each branch; ParentID and ParentPoint say
/// what it hangs on.
std::string encodeTre(const formats::CenterlineTree& tree);

/// Lines of VTK with VMTK's arrays: of points MaximumInscribedSphereRadius and Branch (index of the
/// branch), of lines CenterlineIds, TractIds, GroupIds and Blanking as vmtkbranchextractor gives
/// them. A centerline is the way from a root to a tip, cut into tracts. What leaves a node where
/// vessels fork is blanked as long as it stays in that node's ball, and is one group; the runs in
/// between are groups of their own. Lines share points.
std::string encodeVtpCenterline(const formats::CenterlineTree& tree);

/// Slicer Markups: a curve for each branch, with the measurement "Radius". A child's curve begins on
/// its parent's axis.
std::string encodeCurves(const formats::CenterlineTree& tree);

/// The same of one branch, which has a node.
std::string encodeCurve(const formats::CenterlineTree& tree, const formats::Branch& branch);

/// What "@schema" of a Slicer Markups file says.
inline constexpr const char* kMarkupsSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/"
    "Schema/markups-schema-v1.0.3.json#";

}  // namespace lumen::convert
