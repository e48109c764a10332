// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "converters/base/number_text.h"
#include "converters/export/shared/insertion.h"
#include "converters/export/targets/sofa/scene_parts.h"
#include "converters/export/targets/sofa/scene_tree.h"
#include "formats/case/motion.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

// Alarm beyond the contact distance, mm: a tool that advances 0.1 mm a step swings sideways by no
// more than that, and every 0.1 mm of alarm costs contacts (docs/sofa.md has the measurements).
constexpr double kAlarm = 0.12;
// A grid's contacts begin at the contact distance and not before it, so that is a step wider than
// the radius.
constexpr double kGridSlack = 0.1;
// A wire leads its catheter by the length of its shaped tip and as much again; strokes are a
// hand's.
constexpr double kLead = 30, kStroke = 10;
enum Action : int { kForward = 1, kUseOuter = 8, kUseInner = 9 };

int strokes(double length, double step) {
  return static_cast<int>(std::floor(length / step));
}

/// One action for each time step: BeamAdapter's numbers.
std::vector<int> planActions(const SceneInput& input, double step) {
  const double length = std::min(input.insertion.pathLength, input.instruments.back().length() - 1);
  const int total = strokes(length, step);
  std::vector<int> actions;
  if (input.instruments.size() == 1) {
    actions.assign(static_cast<std::size_t>(total), kForward);
    return actions;
  }
  const int lead = std::min(total, strokes(kLead, step));
  const int stroke = std::max(1, strokes(kStroke, step));
  actions.assign(static_cast<std::size_t>(lead), kForward);
  for (int in = lead; in < total; in += stroke) {
    const auto next = static_cast<std::size_t>(std::min(stroke, total - in));
    actions.push_back(kUseOuter);
    actions.insert(actions.end(), next, kForward);
    actions.push_back(kUseInner);
    actions.insert(actions.end(), next, kForward);
  }
  return actions;
}

std::string spaced(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    text += word;
  }
  return text;
}

void addActions(SceneItem& node, const SceneInput& input, const SofaOptions& options) {
  std::string times, actions;
  const std::vector<int> list = planActions(input, options.step);
  for (std::size_t k = 0; k < list.size(); ++k) {
    // half a step early, so that a sum of time steps that was rounded down is not late
    if (k > 0) times += ' ', actions += ' ';
    times += numberText(k == 0 ? 0 : (static_cast<double>(k) - 0.5) * kPushTime);
    actions += std::to_string(list[k]);
  }
  node.add("BeamAdapterActionController",
           "Pushes, one action in 0.01 s: 1 forward by the controller's step, 8 and 9 choose the "
           "instrument. Without it the controller listens to the arrow keys.")
      .set("name", "script")
      .set("interventionController", "@controller")
      .set("writeMode", 0)
      .set("timeSteps", times)
      .set("actions", actions);
}

double greatestRadius(const SceneInput& input) {
  double greatest = 0;
  for (const Instrument& one : input.instruments) greatest = std::max(greatest, one.radius());
  return greatest;
}

void addInstruments(SceneItem& root, const SceneInput& input, const SofaOptions& options) {
  int beams = 0;
  for (const Instrument& instrument : input.instruments) {
    addRestShape(root, instrument);
    beams += instrument.beams();
  }
  SceneItem& node = root.addNode("instruments", "The instruments, one within the other");
  addBeamSolver(node, beams + 1);
  std::vector<std::string> names, zeros;
  for (const Instrument& instrument : input.instruments) {
    addBeams(node, instrument);
    names.push_back("interpolation_" + instrument.name);
    zeros.emplace_back("0");
  }
  node.add(
          "InterventionalRadiologyController",
          "startingPos: mm and a quaternion that turns x into the direction of insertion; step: mm")
      .set("name", "controller")
      .set("template", "Rigid3d")
      .set("instruments", spaced(names))
      .set("startingPos",
           input.moves ? "@/vessel/motion.carriedPlace" : entryPlace(input.insertion))
      .set("xtip", spaced(zeros))
      .set("rotationInstrument", spaced(zeros))
      .set("step", options.step)
      .set("speed", 0)
      .set("listening", 1)
      .set("controlledInstrument", static_cast<int>(input.instruments.size()) - 1);
  addActions(node, input, options);
  addEntry(node);
  if (isOfCase(options.wall))
    for (const Instrument& instrument : input.instruments)
      addBlobContact(node, instrument, kAlarm + instrument.radius());
  addContactPoints(node, options.wall, greatestRadius(input) + kGridSlack);
  for (const Instrument& instrument : input.instruments) addInstrumentView(node, instrument);
}

}  // namespace

double clearanceFor(double radius) {
  return radius + kAlarm;
}

int stepCount(const SceneInput& input, const SofaOptions& options) {
  return static_cast<int>(planActions(input, options.step).size()) * input.stepsPerPush;
}

int stepsPerPush(const formats::CenterlineTree& tree, const formats::Motion& motion,
                 std::span<const std::uint32_t> path) {
  // of the least radius of the path; more steps than kMost make a scene slow for a thin vessel
  constexpr double kShare = 0.02;
  constexpr int kMost = 10;
  double radius = std::numeric_limits<double>::infinity();
  for (const std::uint32_t node : path) radius = std::min<double>(radius, tree.radius[node]);
  const double way = formats::motionFigures(tree, motion).speed * kPushTime;
  return std::clamp(static_cast<int>(std::ceil(way / (kShare * radius))), 1, kMost);
}

SceneItem makeScene(const SceneInput& input, const SofaOptions& options) {
  SceneItem root{"Node", ""};
  root.set("name", "root").set("dt", kPushTime / input.stepsPerPush).set("gravity", "0 0 0");
  addLoop(root, options.wall, greatestRadius(input), kAlarm);
  addView(root, input.box);
  addVessel(root, options.wall, input);
  addInstruments(root, input, options);
  if (options.dialect == SofaDialect::V23_06) toV23_06(root);
  addPlugins(root);
  return root;
}

std::vector<std::string> aboutScene(const SceneInput& input, const SofaOptions& options) {
  std::string names;
  for (const Instrument& instrument : input.instruments)
    names += (names.empty() ? "A " : " with a ") + instrument.name;
  std::vector<std::string> lines = {
      names + " in the vessels of case.lumen, inserted at the beginning of branch " +
          formats::printable(input.branch) + ".",
      "Positions are those of the case: patient coordinates, LPS, in mm. Masses are in kg and time",
      "is in s, so moduli are in kPa (kg / (mm s^2)), forces in mN and densities in kg / mm^3.",
      "The instrument advances " + numberText(options.step) + " mm in " + numberText(kPushTime) +
          " s, for " + std::to_string(stepCount(input, options)) + " time steps of " +
          numberText(kPushTime / input.stepsPerPush) + " s.",
      "Sources of the instruments' values: docs/sofa.md of lumen."};
  if (input.moves)
    lines.emplace_back(
        "The wall moves as the motion in case.lumen does, whatever touches it, and with it the "
        "place where the instrument enters.");
  return lines;
}

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
