// SPDX-License-Identifier: Apache-2.0
// The vessels at a fork, each followed outwards (docs/measures.md, section 5).
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "converters/judge/measure/vessel_course.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A vessel at a fork.
struct ForkArm {
  std::uint32_t branch = 0;
  bool isUpstream = false;
  std::vector<std::uint32_t> nodes = {};             ///< outwards; the fork's own node is the first
  std::string_view absent = {};                      ///< why it has no vector
  Eigen::Vector3d from = Eigen::Vector3d::Zero();    ///< where it leaves the others' lumen, mm
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();  ///< outwards, one sphere long, mm
  double angleSd = 0;                                ///< of the vector's direction, radians
  double calibre = 0;               ///< mm: radius of the circle of its section's area
  double calibreSd = 0;             ///< mm
  std::string_view noCalibre = {};  ///< why it has no calibre
};

/// Vessels that leave the branches of a tree at each node that has some: `children[node]` are the
/// branches, no aneurysms.
std::map<std::uint32_t, std::vector<std::uint32_t>> childrenOfNodes(
    const formats::CenterlineTree& tree);

/// The arms of a fork: the one upstream first, then the rest of its branch if that goes on for
/// more than a radius, then the children.
std::vector<ForkArm> armsOf(const formats::CenterlineTree& tree, std::uint32_t node,
                            const std::vector<std::uint32_t>& children);

/// Finds where each arm leaves the tubes of the others, its vector and its calibre.
void measureArms(const formats::CenterlineTree& tree, const std::vector<VesselCourse>& courses,
                 std::vector<ForkArm>& arms);

}  // namespace lumen::convert
