// SPDX-License-Identifier: Apache-2.0
// Poses of nodes at any time, and how far a motion bends its tree; see spec/lumen.md, "Motion".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/case/case.h"
#include "formats/field/pose.h"
#include "formats/view/case_view.h"

namespace lumen::formats {

// A tree, and what its nodes own, at poses of the nodes; see spec/lumen.md, "The posed case".

/// The pose in doubles; its rotation is divided by its length.
field::NodePose nodePoseOf(const Pose& pose);

/// Carries the centres, directions, radii and heights of all nodes. `poses`: one for each node.
void carryTree(const std::vector<field::NodePose>& poses, CenterlineTree& tree);

/// Carries positions (mm, LPS), of which node i owns offset[i] to offset[i + 1] - 1: wall points, or
/// centres of blobs. `rest`: the tree before it was carried.
void carryOwned(const CenterlineTree& rest, const std::vector<field::NodePose>& poses,
                const std::vector<std::uint32_t>& offset, std::vector<Vec3f>& positions);

/// The motion of a case, among names of node arrays.
inline constexpr const char* kMotionName = "motion";

/// Version of a file that holds `value`.
FormatVersion versionOf(const Case& value);

/// The motion of a file.
Motion motionOf(const MotionView& view);

/// Turns the chunk of a motion that a program of version 1.1, which did not know it, left among the
/// other chunks into the motion, unless there is one. Reports JSON_CHUNK_DATA for one that cannot
/// be read.
void takeMotion(Case& value, IssueList& issues);

/// Poses of all nodes at a time (s): those of the motion, and of the others the pose at rest.
std::vector<field::NodePose> posesAt(const CenterlineTree& tree, const Motion& motion, double time);

/// Figures of a motion over all of its times.
struct MotionFigures {
  double displacement = 0;  ///< mm: longest distance of a node's centre from its centre at rest
  double speed = 0;         ///< mm/s: greatest of a node's centre, from time to time
  double strain = 0;        ///< greatest strain of an edge, as the specification defines it
};
MotionFigures motionFigures(const CenterlineTree& tree, const Motion& motion);

/// Drops the motion of nodes that do not stay, and renames the others: newIndex[i] is the index of
/// node i afterwards. A motion without nodes is dropped.
void keepMotionOf(std::optional<Motion>& motion, const std::vector<bool>& stays,
                  const std::vector<std::uint32_t>& newIndex);

}  // namespace lumen::formats
