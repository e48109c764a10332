// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/number_text.h"
#include "converters/export/shared/flow_inlets.h"
#include "converters/export/shared/flow_outlets.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/oned/oned_network.h"
#include "converters/export/targets/targets.h"

namespace lumen::convert {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kCm = 100, kCm2 = 1e4, kCm3 = 1e6;  // cgs units in one of SI
constexpr double kDyn = 10;                          // dyn/cm^2 of Pa

template <class... Words>
std::string line(const Words&... words) {
  std::string text;
  ((text += (text.empty() ? "" : " ") + std::string(words)), ...);
  return text + "\n";
}

std::string jointCards(const OneDNetwork& network) {
  std::string text;
  for (std::size_t node = 0; node < network.nodes.size(); ++node) {
    std::string in, out;
    std::size_t ins = 0, outs = 0;
    for (std::size_t v = 0; v < network.vessels.size(); ++v) {
      if (network.vessels[v].to == node) in += " " + std::to_string(v), ++ins;
      if (network.vessels[v].from == node) out += " " + std::to_string(v), ++outs;
    }
    if (ins == 0 || outs == 0) continue;
    const std::string n = std::to_string(node);
    text += line("JOINT", "JOINT" + n, n, "IN" + n, "OUT" + n) + "JOINTINLET IN" + n + " " +
            std::to_string(ins) + in + "\nJOINTOUTLET OUT" + n + " " + std::to_string(outs) + out +
            "\n";
  }
  return text;
}

std::string segmentCards(const OneDNetwork& network) {
  std::string text, tables;
  for (std::size_t v = 0; v < network.vessels.size(); ++v) {
    const OneDVessel& vessel = network.vessels[v];
    const std::string id = std::to_string(v);
    const auto area = [](double r) { return numberText(kCm2 * kPi * r * r); };
    const bool isOutlet = vessel.resistance > 0;
    text += line("SEGMENT", vessel.name, id, numberText(kCm * vessel.length),
                 std::to_string(vessel.cells()), std::to_string(vessel.from),
                 std::to_string(vessel.to), area(vessel.inRadius), area(vessel.outRadius),
                 "0.0 MAT1 NONE 0.0 0 0", isOutlet ? "RESISTANCE R" + id : "NOBOUND NONE");
    if (isOutlet)
      tables += "DATATABLE R" + id + " LIST\n0.0 " +
                numberText(kCgsResistance * vessel.resistance) + "\nENDDATATABLE\n";
  }
  return text + "\n" + tables;
}

/// Input of svOneDSolver, cgs.
std::string inputCards(const OneDNetwork& network, const std::string& name) {
  std::string nodes;
  for (std::size_t n = 0; n < network.nodes.size(); ++n) {
    const Eigen::Vector3d p = 0.1 * network.nodes[n];
    nodes +=
        line("NODE", std::to_string(n), numberText(p.x()), numberText(p.y()), numberText(p.z()));
  }
  // SOLVEROPTIONS in the text: steps of 1 ms for 2 s, each fiftieth kept; Gauss points, tolerance,
  // conservative form, stabilised. The parabola of a Poiseuille flow has the exponent 2; radii are
  // those at the mean pressure.
  return exportText(
      "oned/vessels.in",
      {{"name", name},
       {"nodes", nodes},
       {"joints", jointCards(network)},
       {"segments", segmentCards(network)},
       {"flow", numberText(kCm3 * network.flow)},
       {"material",
        line("MATERIAL MAT1 OLUFSEN", numberText(blood::kDensity / 1e3),
             numberText(10 * blood::kViscosity), numberText(kDyn * blood::kMeanPressure), "2.0",
             numberText(kDyn * blood::kStiffness1), numberText(blood::kStiffness2 / kCm),
             numberText(kDyn * blood::kStiffness3))}});
}

/// The end of a vessel of openBF: the impedance that a wave meets, the rest of the resistance, and
/// a compliance.
std::string windkessel(const OneDVessel& vessel, double stiffness) {
  const double r = vessel.outRadius, area = kPi * r * r;
  // c^2 = (A / rho) dp/dA at the mean pressure, of the wall that blood.h states
  const double speed = std::sqrt(stiffness / (1.5 * blood::kDensity));
  constexpr double kMostShare = 0.5;  // share of the whole, should a wave meet more than that
  const double first = std::min(blood::kDensity * speed / area, kMostShare * vessel.resistance);
  const double second = vessel.resistance - first;
  return "    R1: " + numberText(first) + "\n    R2: " + numberText(second) +
         "\n    Cc: " + numberText(blood::kDecay / second) + "\n";
}

/// Input of openBF v2, SI.
std::string yaml(const OneDNetwork& network, const std::string& name) {
  std::string text;
  for (const OneDVessel& vessel : network.vessels) {
    const double mean = vessel.meanRadius(), stiffness = blood::stiffness(mean);
    text += "  - label: \"" + vessel.name + "\"\n    sn: " + std::to_string(vessel.from + 1) +
            "\n    tn: " + std::to_string(vessel.to + 1) + "\n    L: " + numberText(vessel.length) +
            "\n    M: " + std::to_string(vessel.cells()) +
            "\n    Rp: " + numberText(vessel.inRadius) +
            "\n    Rd: " + numberText(vessel.outRadius) +
            "\n    h0: " + numberText(blood::kThickness * mean) +
            "\n    E: " + numberText(stiffness / blood::kThickness) +
            "\n    Pext: " + numberText(blood::kMeanPressure) + "\n";
    if (vessel.resistance > 0) text += windkessel(vessel, stiffness);
  }
  return exportText("oned/vessels.yml", {{"name", name},
                                         {"density", numberText(blood::kDensity)},
                                         {"viscosity", numberText(blood::kViscosity)},
                                         {"vessels", text}});
}

void addTree(ExportResult& result, const OneDNetwork& network, const std::string& name) {
  const std::string flow = numberText(network.flow);
  result.files.push_back(
      {name + ".in", inputCards(network, name), "for svOneDSolver, in cgs", "cm"});
  result.files.push_back({name + ".yml", yaml(network, name), "for openBF v2, in SI", "m"});
  result.files.push_back({name + "_inlet.dat", "0.0 " + flow + "\n1.0 " + flow + "\n",
                          "the flow into it: s, m^3/s", "m"});
}

}  // namespace

ExportResult exportOneD(const ExportInput& input) {
  const std::vector<StatedInlet> inlets = statedInlets(input.options.inlets, input.options.word);
  FlowCase flowing = flowCase(input.source, inlets, input.options.word, input.options.keepEnds);
  const FlowNetwork network = flowNetwork(flowing.value.tree, inlets);
  ExportResult result;
  result.start = exportText("oned/README.md");
  std::size_t stubs = 0, lengthened = 0;
  for (std::uint32_t t = 0; t < network.trees.size(); ++t) {
    const OneDNetwork tree = oneDNetwork(network, t);
    stubs += tree.stubs;
    lengthened += tree.lengthened;
    addTree(result, tree, t == 0 ? "vessels" : "vessels" + std::to_string(t + 1));
  }
  result.ends = findEnds(network);
  result.losses = std::move(flowing.losses);
  result.losses.insert(result.losses.end(), network.messages.begin(), network.messages.end());
  addOutlets(network, result);
  if (lengthened > 0)
    result.losses.push_back("segments that are shorter than their radius are as long as it here: " +
                            std::to_string(lengthened));
  result.remarks = {networkSummary(network),
                    "stubs where more than three vessels meet: " + std::to_string(stubs)};
  return result;
}

TargetRow oneDRow() {
  return {.name = "oned",
          .title = "svOneDSolver and openBF",
          .files = {"vessels.in", "vessels.yml", "vessels_inlet.dat"},
          .units = {LengthUnit::Centimetre},
          .axes = {Axes::Lps},
          .holds = "lengths, radii, junctions; svOneDSolver also positions of junctions",
          .lacks = "aneurysms; the shape of sections; of vessels all but a cone",
          .options = {"inlets", "keep-ends"},
          .needsModels = false};
}

}  // namespace lumen::convert
