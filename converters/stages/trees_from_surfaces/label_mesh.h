// SPDX-License-Identifier: Apache-2.0
// Labels of a volume as a closed surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/geometry/mesh_measures.h"
#include "converters/io/labels/label_table.h"
#include "converters/voxels/label_voxels.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Voxels of a volume: for each the place of its label among the names, counted from 1; 0 for all
/// others.
struct LabelMask {
  VolumeGeometry geometry;
  std::vector<std::uint8_t> label;
  std::vector<std::int64_t> values;  ///< of the labels, ascending
  std::vector<std::string> names;    ///< as many
  bool isGrey = false;               ///< neighbours differ as the grey values of an image do
};

/// The voxels with these labels; all but 0, called "label-N", if `wanted` is empty. Throws
/// Error(InvalidInput), `name` (of the file, printable) first, for voxels that are no whole
/// numbers, more than 255 labels, and a label that no voxel has; this message lists the labels of
/// the volume.
LabelMask makeLabelMask(const Volume& volume, const LabelNames& wanted, const std::string& name);

struct LabelSurface {
  /// mm, LPS, oriented, manifold, and closed but where the volume cuts vessels off.
  TriangleMesh mesh;
  std::size_t cavities = 0;  ///< holes within that were filled
};

/// The surface of all labels in one (docs/method.md, section 10): their voxels, smoothed by a
/// kernel whose second moments are zero, so that round walls stay where they are. No voxel's centre
/// changes sides. Vessels that the volume cuts off are open there, half a voxel beyond the last
/// centres. Memory: a byte a voxel, and the surroundings of labels. The result has the same bits on
/// any number of threads. Throws Error(Cancelled).
LabelSurface makeLabelSurface(const LabelMask& mask, const Progress& progress);

// Names of branches by the labels along them.

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
///   follows the other; nodes without a label belong to the stretch before them, or after. At an end
///   of the branch they are a branch of their own if they are another vessel than the stretch: longer
///   than they are wide, and wider than the parent of two such vessels, or, at its beginning, longer
///   than the stretch.
/// - A branch has the name of the label with the greatest length along it, the lower value of two that
///   are equal, if that is longer than the branch is wide or is at least half of it; one without keeps its name.
/// - Branches of one name are "NAME", "NAME-2" and so on in the order of the tree.
Naming nameBranches(const LabelMask& mask, formats::Case& value);

/// The label after which nameBranches() names a branch, by its place counted from 1, 0 for none; and
/// the nodes [first, end) from the first to the last with any label, none if both are equal.
struct NamedStretch {
  std::uint8_t label = 0;
  std::uint32_t first = 0, end = 0;
};

/// One for each branch, which is not divided.
std::vector<NamedStretch> labelsAlong(const LabelMask& mask, const formats::CenterlineTree& tree);

/// The label of the voxel around a position, mm, LPS, counted from 1; 0 outside.
std::uint8_t labelAt(const LabelMask& mask, const Eigen::Vector3d& position);

/// The number of labelled voxels whose centres lie in a volume of this geometry.
std::size_t labelledWithin(const LabelMask& mask, const VolumeGeometry& geometry);

}  // namespace lumen::convert
