// SPDX-License-Identifier: Apache-2.0
// Names of branches by the labels along them.
#pragma once

#include <cstddef>

#include "converters/stages/trees_from_surfaces/label_mesh.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct Naming {
  std::size_t named = 0;    ///< branches that got the name of a label
  std::size_t bare = 0;     ///< branches on no label, which keep their names
  std::size_t divided = 0;  ///< branches that were divided where one label follows another
};

/// Names the branches of a case by the labels of the voxels nearest to their nodes (docs/method.md,
/// section 10, *Names*). Positions are compared in mm, LPS, so the labels may have another grid than
/// the volume of the case.
/// - Nodes within the ball of the node from which a branch leaves its parent do not count, unless all
///   are.
/// - A branch with stretches of several labels, each longer than it is wide there, is divided where one
///   follows the other; nodes without a label belong to the stretch before them, or after.
/// - A branch has the name of the label with the greatest length along it, the lower value of two that
///   are equal, if that is longer than the branch is wide or is at least half of it; one without keeps its name.
/// - Branches of one name are "NAME", "NAME-2" and so on in the order of the tree.
Naming nameBranches(const LabelMask& mask, formats::Case& value);

/// The number of labelled voxels whose centres lie in a volume of this geometry.
std::size_t labelledWithin(const LabelMask& mask, const VolumeGeometry& geometry);

}  // namespace lumen::convert
