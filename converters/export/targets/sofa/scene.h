// SPDX-License-Identifier: Apache-2.0
// A scene of SOFA: instruments of BeamAdapter that are pushed into the vessels of a case.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "converters/export/shared/insertion.h"
#include "converters/export/targets/sofa/instrument.h"
#include "converters/export/targets/sofa/scene_tree.h"
#include "converters/export/targets/sofa/sofa_options.h"
#include "converters/export/targets/sofa/vessel_tube.h"
#include "converters/geometry/box.h"

namespace lumen::convert {

/// A grid of samples that a scene refers to.
struct SceneGrid {
  std::array<int, 3> size{};
  /// mm, LPS: the positions of its corner samples
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero();
};

/// The case and the instruments of a scene.
struct SceneInput {
  Insertion insertion;
  std::string branch;  ///< its label
  std::vector<Instrument> instruments;
  Box3d box;                        ///< around the vessels, mm, LPS
  SceneGrid grid;                   ///< grid of WallKind::Grid
  std::vector<VesselFrame> frames;  ///< frames of WallKind::Soft
  bool moves = false;               ///< the case's motion moves the wall
};

/// Distance from the wall, mm, that the insertion of instruments of such a radius needs.
double clearanceFor(double radius);

/// Number of time steps of the insertion.
int stepCount(const SceneInput& input, const SofaOptions& options);

SceneItem makeScene(const SceneInput& input, const SofaOptions& options);

/// Lines at the head of each file of the scene: frame, units, how to start.
std::vector<std::string> aboutScene(const SceneInput& input, const SofaOptions& options);

}  // namespace lumen::convert
