// SPDX-License-Identifier: Apache-2.0
// A vessel that gives way in a scene of SOFA: frames along it, joined by beams and held by tissue.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "converters/export/targets/sofa/scene_tree.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// A frame that carries a node of the case's tree.
struct VesselFrame {
  std::uint32_t node = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        ///< mm, LPS
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< turns x along the vessel
  double radius = 0;                                         ///< of the lumen, mm
};

/// Frames on nodes of a path, from the first on, at least 1.3 radii apart.
std::vector<VesselFrame> framesAlong(const formats::CenterlineTree& tree,
                                     const std::vector<std::uint32_t>& path);

/// Adds the tube of these frames to the node of the vessel, behind its BlobField.
void addTube(SceneItem& vessel, const std::vector<VesselFrame>& frames);

}  // namespace lumen::convert
