// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/vessel_tube.h"

#include <algorithm>
#include <string>

#include "converters/export/shared/insertion.h"

namespace lumen::convert {

namespace {

// Sources: docs/sofa.md, "A vessel that gives way".
constexpr double kWallYoung = 800;     // kPa
constexpr double kWallShare = 0.25;    // thickness of the wall over the radius
constexpr double kWallPoisson = 0.49;  // nearly incompressible, as BeamAdapter's shear modulus asks
constexpr double kTissue = 10;         // kPa: mN / mm for each mm of vessel
constexpr double kTissueTime = 0.05;   // s, within which tissue follows
constexpr double kDensity = 1.06e-6;   // kg / mm^3
constexpr double kSpacing = 1.3;       // radii between frames

Eigen::Vector3d centreOfNode(const formats::CenterlineTree& tree, std::uint32_t node) {
  const formats::Vec3f& c = tree.centre[node];
  return {c.x, c.y, c.z};
}

double edgeLength(const std::vector<VesselFrame>& frames, std::size_t after) {
  return (frames[after].position - frames[after - 1].position).norm();
}

/// Half of the edges at a frame: the length of vessel that it stands for, mm.
double lengthAt(const std::vector<VesselFrame>& frames, std::size_t k) {
  return 0.5 * ((k > 0 ? edgeLength(frames, k) : 0) +
                (k + 1 < frames.size() ? edgeLength(frames, k + 1) : 0));
}

void addBeamsOfTube(SceneItem& vessel, const std::vector<VesselFrame>& frames) {
  std::vector<double> outer, inner, young, poisson, unused;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    const double radius = 0.5 * (frames[k - 1].radius + frames[k].radius);
    inner.push_back(radius);
    outer.push_back(radius * (1 + kWallShare));
    young.push_back(kWallYoung);
    poisson.push_back(kWallPoisson);
    unused.push_back(1);
  }
  // a list that is shorter than the beams makes BeamAdapter take the first radius for all of them
  vessel.add("BeamInterpolation", "The wall as tubes; radii in mm, modulus in kPa")
      .set("name", "interpolation")
      .set("straight", 0)
      .set("radius", sceneNumbers(outer))
      .set("innerRadius", sceneNumbers(inner))
      .set("lengthY", sceneNumbers(unused))
      .set("lengthZ", sceneNumbers(unused))
      .set("defaultYoungModulus", sceneNumbers(young))
      .set("defaultPoissonRatio", sceneNumbers(poisson));
  vessel.add("AdaptiveBeamForceFieldAndMass", "massDensity in kg / mm^3")
      .set("name", "forces")
      .set("interpolation", "@interpolation")
      .set("massDensity", kDensity)
      .set("computeMass", 1);
}

void addTissue(SceneItem& vessel, const std::vector<VesselFrame>& frames) {
  std::vector<double> springs, turns;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    springs.push_back(kTissue * lengthAt(frames, k));
    turns.push_back(springs.back() * frames[k].radius * frames[k].radius);
  }
  vessel.add("RestShapeSpringsForceField", "The tissue around it: mN / mm and mN mm / rad")
      .set("name", "tissue")
      .set("stiffness", sceneNumbers(springs))
      .set("angularStiffness", sceneNumbers(turns));
}

}  // namespace

std::vector<VesselFrame> framesAlong(const formats::CenterlineTree& tree,
                                     const std::vector<std::uint32_t>& path) {
  std::vector<VesselFrame> frames;
  for (const std::uint32_t node : path) {
    const Eigen::Vector3d at = centreOfNode(tree, node);
    const double radius = tree.radius[node];
    if (!frames.empty() && (at - frames.back().position).norm() < kSpacing * radius) continue;
    frames.push_back({node, at, Eigen::Quaterniond::Identity(), radius});
  }
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, frames.size() - 1);
    const Eigen::Vector3d along = frames[after].position - frames[before].position;
    if (along.norm() > 0) frames[k].turn = turnTo(along.normalized());
  }
  return frames;
}

void addTube(SceneItem& vessel, const std::vector<VesselFrame>& frames) {
  std::vector<double> positions, places;
  std::string nodes, edges;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Eigen::Vector3d& p = frames[k].position;
    const Eigen::Quaterniond& q = frames[k].turn;
    positions.insert(positions.end(), {p.x(), p.y(), p.z()});
    places.insert(places.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
    nodes += (k == 0 ? "" : " ") + std::to_string(frames[k].node);
    if (k > 0) edges += (k == 1 ? "" : " ") + std::to_string(k - 1) + " " + std::to_string(k);
  }
  vessel.add("EulerImplicitSolver", "rayleighStiffness: s, within which tissue and wall follow")
      .set("name", "time")
      .set("rayleighStiffness", kTissueTime)
      .set("rayleighMass", 0);
  vessel.add("BTDLinearSolver").set("name", "solver");
  vessel.add("MeshTopology")
      .set("name", "lines")
      .set("position", sceneNumbers(positions))
      .set("edges", edges);
  vessel.add("MechanicalObject", "Frames, mm and a quaternion that turns x along the vessel")
      .set("name", "frames")
      .set("template", "Rigid3d")
      .set("position", sceneNumbers(places));
  addBeamsOfTube(vessel, frames);
  addTissue(vessel, frames);
  vessel.add("LinearSolverConstraintCorrection")
      .set("name", "correction")
      .set("wire_optimization", 1);
  vessel.add("BlobPose", "Takes the wall along with the frames; nodes: of the case's tree")
      .set("name", "pose")
      .set("field", "@wall")
      .set("nodes", nodes);
}

}  // namespace lumen::convert
