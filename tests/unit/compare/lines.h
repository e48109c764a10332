// SPDX-License-Identifier: Apache-2.0
// Small trees that can be scored by hand.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/base/progress.h"
#include "converters/judge/compare/compare.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Appends a straight branch from `a` to `b`, mm, with nodes 0.5 mm apart.
inline void addLine(formats::Case& value, const std::string& label, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b, double radius,
                    std::int32_t parentNode = formats::kNoParent,
                    formats::BranchKind kind = formats::BranchKind::Vessel) {
  formats::CenterlineTree& tree = value.tree;
  const Eigen::Vector3d along = (b - a).normalized();
  const int steps = std::max(1, static_cast<int>((b - a).norm() / 0.5 + 0.5));
  const auto first = static_cast<std::uint32_t>(tree.nodeCount());
  const auto asFloat = [](const Eigen::Vector3d& v) {
    return formats::Vec3f{static_cast<float>(v.x()), static_cast<float>(v.y()),
                          static_cast<float>(v.z())};
  };
  for (int i = 0; i <= steps; ++i) {
    tree.centre.push_back(asFloat(a + (b - a) * i / steps));
    tree.direction.push_back(asFloat(along));
    tree.radius.push_back(static_cast<float>(radius));
    tree.height.push_back(0.5F);
    tree.parent.push_back(i == 0 ? parentNode : static_cast<std::int32_t>(tree.nodeCount()) - 2);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
  }
  tree.branches.push_back({label,
                           kind,
                           parentNode,
                           first,
                           static_cast<std::uint32_t>(steps) + 1,
                           formats::StopReason::Unknown,
                           {}});
}

/// One line of 20 mm along x, radius 1.
inline formats::Case straightTruth() {
  formats::Case truth;
  truth.metadata.voxelSize = 0.4;
  addLine(truth, "root", {0, 0, 0}, {20, 0, 0}, 1);
  return truth;
}

inline Comparison compared(const formats::Case& found, const formats::Case& truth) {
  Progress progress;
  return compareCases(found, truth, progress);
}

}  // namespace lumen::convert
