// SPDX-License-Identifier: Apache-2.0
// Inlets of a tree besides its root (docs/method.md, section 1.14).
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "formats/case/case.h"

namespace lumen::convert {

/// Ends at which blood comes into a tree besides its root. A vessel feeds no wider ones: where both
/// arms of a fork are wider than the whole vessel that leads to it, as behind a communicating artery,
/// blood comes from the widest end of the volume beyond that fork. `isInside`: a point, mm, LPS,
/// lies in the volume. Returns the centres of the inlets of each such tree: its root, and then those
/// ends, the farthest from the root first.
std::vector<Eigen::Vector3d> furtherInlets(
    const formats::CenterlineTree& tree,
    const std::function<bool(const Eigen::Vector3d&)>& isInside);

}  // namespace lumen::convert
