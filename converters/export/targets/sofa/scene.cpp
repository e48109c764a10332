// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/sofa/scene.h"

#include <algorithm>
#include <cmath>

#include "converters/base/number_text.h"
#include "converters/export/targets/sofa/dialect.h"
#include "converters/export/targets/sofa/scene_parts.h"
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
    times += numberText(k == 0 ? 0 : (static_cast<double>(k) - 0.5) * kTimeStep);
    actions += std::to_string(list[k]);
  }
  node.add("BeamAdapterActionController",
           "Pushes, one action in a time step: 1 forward by the controller's step, 8 and 9 choose "
           "the "
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
  return static_cast<int>(planActions(input, options.step).size());
}

SceneItem makeScene(const SceneInput& input, const SofaOptions& options) {
  SceneItem root{"Node", ""};
  root.set("name", "root").set("dt", kTimeStep).set("gravity", "0 0 0");
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
      "The instrument advances " + numberText(options.step) + " mm in a time step of " +
          numberText(kTimeStep) + " s, for " + std::to_string(stepCount(input, options)) +
          " steps.",
      "Sources of the instruments' values: docs/sofa.md of lumen."};
  if (input.moves)
    lines.emplace_back(
        "The wall moves as the motion in case.lumen does, whatever touches it, and with it the "
        "place where the instrument enters.");
  return lines;
}

}  // namespace lumen::convert
