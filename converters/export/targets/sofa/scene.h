// SPDX-License-Identifier: Apache-2.0
// A scene of SOFA: instruments of BeamAdapter that are pushed into the vessels of a case.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "converters/export/shared/insertion.h"
#include "converters/export/targets/sofa/export_sofa.h"
#include "converters/export/targets/sofa/instrument.h"
#include "converters/export/targets/sofa/scene_tree.h"
#include "converters/geometry/box.h"
#include "formats/case/case.h"

namespace lumen::convert {

// A vessel that gives way in a scene of SOFA: frames along it, joined by beams and held by tissue.

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

/// A grid of samples that a scene refers to.
struct SceneGrid {
  std::array<int, 3> size{};
  /// mm, LPS: the positions of its corner samples
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero();
};

/// The surface of a system of vessels, to be looked at in a colour of its own.
struct SceneSystem {
  std::string name;               ///< "true_lumen": of nodes, which are variables in Python
  std::string file;               ///< "vessel-true-lumen.obj"
  std::array<double, 3> color{};  ///< sRGB, 0 to 1
};

/// The case and the instruments of a scene.
struct SceneInput {
  Insertion insertion;
  std::string branch;  ///< its label
  std::vector<Instrument> instruments;
  Box3d box;                         ///< around the vessels, mm, LPS
  SceneGrid grid;                    ///< grid of WallKind::Grid
  std::vector<VesselFrame> frames;   ///< frames of WallKind::Soft
  std::vector<SceneSystem> systems;  ///< of the vessels; none if the case states none
  bool moves = false;                ///< the case's motion moves the wall
  int stepsPerPush = 1;              ///< time steps of a scene from push to push
};

/// s: an instrument that is pushed by 0.1 mm in it moves at 10 mm / s, as a hand moves it.
inline constexpr double kPushTime = 0.01;

/// Distance from the wall, mm, that the insertion of instruments of such a radius needs.
double clearanceFor(double radius);

/// Number of time steps from push to push in which the wall moves so little in each that contacts,
/// which see it as planes, hold an instrument: see docs/sofa.md, "A vessel that moves".
int stepsPerPush(const formats::CenterlineTree& tree, const formats::Motion& motion,
                 std::span<const std::uint32_t> path);

/// Number of time steps of the insertion.
int stepCount(const SceneInput& input, const SofaOptions& options);

SceneItem makeScene(const SceneInput& input, const SofaOptions& options);

/// Lines at the head of each file of the scene: frame, units, how to start.
std::vector<std::string> aboutScene(const SceneInput& input, const SofaOptions& options);

}  // namespace lumen::convert
