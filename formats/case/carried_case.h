// SPDX-License-Identifier: Apache-2.0
// A tree, and what its nodes own, at poses of the nodes; see spec/lumen.md, "The posed case".
#pragma once

#include <cstdint>
#include <vector>

#include "formats/case/case.h"
#include "formats/field/pose.h"

namespace lumen::formats {

/// The pose in doubles; its rotation is divided by its length.
field::NodePose nodePoseOf(const Pose& pose);

/// Carries the centres, directions, radii and heights of all nodes. `poses`: one for each node.
void carryTree(const std::vector<field::NodePose>& poses, CenterlineTree& tree);

/// Carries positions (mm, LPS), of which node i owns offset[i] to offset[i + 1] - 1: wall points, or
/// centres of blobs. `rest`: the tree before it was carried.
void carryOwned(const CenterlineTree& rest, const std::vector<field::NodePose>& poses,
                const std::vector<std::uint32_t>& offset, std::vector<Vec3f>& positions);

}  // namespace lumen::formats
