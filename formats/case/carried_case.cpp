// SPDX-License-Identifier: Apache-2.0
#include "formats/case/carried_case.h"

#include <cstddef>

namespace lumen::formats {

using field::NodePose;

namespace {

field::Vec exact(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

Vec3f rounded(const field::Vec& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

NodePose nodePoseOf(const Pose& pose) {
  const auto& q = pose.rotation;
  return {exact(pose.centre), field::unit({q[0], q[1], q[2], q[3]}), pose.factor};
}

void carryTree(const std::vector<NodePose>& poses, CenterlineTree& tree) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    tree.centre[i] = rounded(poses[i].centre);
    tree.direction[i] = rounded(rotated(poses[i].rotation, exact(tree.direction[i])));
    tree.radius[i] = static_cast<float>(poses[i].factor * tree.radius[i]);
    tree.height[i] = static_cast<float>(poses[i].factor * tree.height[i]);
  }
}

void carryOwned(const CenterlineTree& rest, const std::vector<NodePose>& poses,
                const std::vector<std::uint32_t>& offset, std::vector<Vec3f>& positions) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::uint32_t k = offset[i]; k < offset[i + 1]; ++k)
      positions[k] = rounded(carried(poses[i], exact(rest.centre[i]), exact(positions[k])));
}

}  // namespace lumen::formats
