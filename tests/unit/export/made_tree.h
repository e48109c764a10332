// SPDX-License-Identifier: Apache-2.0
// Trees for tests, branch by branch.
#pragma once

#include <cstdint>
#include <string>

#include "formats/case/case.h"

namespace lumen::convert {

/// Adds a straight branch: its first node at `from`, each next one a `step` on; mm.
inline void addBranch(formats::CenterlineTree& tree, const std::string& label, int parent,
                      const formats::Vec3f& from, const formats::Vec3f& step, int nodes,
                      float radius, formats::BranchKind kind = formats::BranchKind::Vessel) {
  formats::Branch branch;
  branch.label = label;
  branch.kind = kind;
  branch.parentNode = parent;
  branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
  branch.nodeCount = static_cast<std::uint32_t>(nodes);
  for (int k = 0; k < nodes; ++k) {
    const auto s = static_cast<float>(k);
    tree.parent.push_back(k == 0 ? parent : static_cast<int>(tree.nodeCount()) - 1);
    tree.centre.push_back({from.x + s * step.x, from.y + s * step.y, from.z + s * step.z});
    tree.direction.push_back(step);
    tree.radius.push_back(radius);
    tree.height.push_back(1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
  }
  tree.branches.push_back(branch);
}

}  // namespace lumen::convert
