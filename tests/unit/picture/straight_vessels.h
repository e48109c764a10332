// SPDX-License-Identifier: Apache-2.0
// Cases of straight vessels whose surface is known.
#pragma once

#include <string>
#include <vector>

#include "converters/base/vectors.h"
#include "formats/case/case.h"
#include "straight_models.h"

namespace lumen::test {

struct StraightVessel {
  Eigen::Vector3d from, to;
};

/// Vessels that are not connected, all of one radius, with a node each half radius and, along them, models that are
/// exact cylinders.
inline formats::Case straightVessels(const std::vector<StraightVessel>& vessels, double radius) {
  formats::Case value;
  formats::CenterlineTree& tree = value.tree;
  for (const StraightVessel& vessel : vessels) {
    formats::Branch branch;
    branch.label = "vessel " + std::to_string(tree.branches.size());
    branch.firstNode = static_cast<std::uint32_t>(tree.nodeCount());
    const Eigen::Vector3d chord = vessel.to - vessel.from;
    const int steps = static_cast<int>(chord.norm() / (0.5 * radius));
    for (int i = 0; i <= steps; ++i) {
      tree.centre.push_back(toVec3f(vessel.from + chord * i / steps));
      tree.direction.push_back(toVec3f(chord.normalized()));
      tree.radius.push_back(static_cast<float>(radius));
      tree.height.push_back(static_cast<float>(radius));
      tree.parent.push_back(i == 0 ? formats::kNoParent
                                   : static_cast<std::int32_t>(tree.nodeCount()) - 2);
      tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
    }
    branch.nodeCount = static_cast<std::uint32_t>(tree.nodeCount()) - branch.firstNode;
    tree.branches.push_back(branch);
  }
  convert::addStraightModels(value, radius);
  return value;
}

}  // namespace lumen::test
