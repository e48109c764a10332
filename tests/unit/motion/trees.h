// SPDX-License-Identifier: Apache-2.0
// Small trees for the tests of motion.
#pragma once

#include <string>

#include "converters/base/vectors.h"
#include "formats/case/case.h"

namespace lumen::convert::test {

/// Appends a branch of `count` nodes from `from` by `step` mm each, all of one radius; its first node hangs
/// on `parent`, or is a root if that is -1. Returns its last node.
inline std::int32_t addBranch(formats::CenterlineTree& tree, std::int32_t parent,
                              const Eigen::Vector3d& from, const Eigen::Vector3d& step, int count,
                              float radius) {
  formats::Branch branch;
  branch.label = "b" + std::to_string(tree.branches.size());
  branch.parentNode = parent;
  branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
  branch.nodeCount = static_cast<std::uint32_t>(count);
  for (int n = 0; n < count; ++n) {
    tree.parent.push_back(n == 0 ? parent : static_cast<std::int32_t>(tree.nodeCount()) - 1);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    tree.direction.push_back(toVec3f(step.normalized()));
    tree.radius.push_back(radius);
    tree.height.push_back(static_cast<float>(step.norm()));
    tree.centre.push_back(toVec3f(from + n * step));
  }
  tree.branches.push_back(branch);
  return static_cast<std::int32_t>(tree.nodeCount()) - 1;
}

/// A trunk of 21 nodes along z and two arms of 11, 0.5 mm apart.
inline formats::CenterlineTree forkedTree() {
  formats::CenterlineTree tree;
  addBranch(tree, -1, {0, 0, 0}, {0, 0, 0.5}, 21, 1.0F);
  addBranch(tree, 12, {0.5, 0, 6}, {0.5, 0, 0}, 11, 0.6F);
  addBranch(tree, 16, {0, 0.5, 8}, {0, 0.5, 0}, 11, 0.6F);
  return tree;
}

}  // namespace lumen::convert::test
