// SPDX-License-Identifier: Apache-2.0
// Declared in targets.h.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/export/shared/flow_inlets.h"
#include "converters/export/shared/flow_outlets.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/network.h"
#include "converters/export/shared/text_files.h"
#include "converters/export/targets/targets.h"
#include "converters/io/mesh/mesh_parts.h"

namespace lumen::convert {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kCgsFlow = 1e6;        // cm^3/s of m^3/s
constexpr double kCgsInertance = 1e-5;  // dyn s^2/cm^5 of Pa s^2/m^3
constexpr double kCgsCompliance = 1e5;  // cm^5/dyn of m^3/Pa

// Seconds until the flow that walls take up is settled; the last one is answered.
constexpr int kCycles = 10;

/// Place of an end, cm, LPS: the solver passes over names that begin with "_".
Json placeJson(const FlowNetwork& network, std::uint32_t joint) {
  const Eigen::Vector3d p = kCentimetres * network.joints[joint].place;
  return Json::array({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0});
}

/// "branch2_seg0", by which SimVascular's tools find a vessel's parts again.
std::vector<std::string> vesselNames(const FlowNetwork& network) {
  std::map<std::uint32_t, int> parts;
  std::vector<std::string> names;
  for (const FlowSegment& segment : network.segments)
    names.push_back("branch" + std::to_string(segment.branch) + "_seg" +
                    std::to_string(parts[segment.branch]++));
  return names;
}

/// Names of joints, of ends as OpenFOAM takes them.
std::vector<std::string> jointNames(const FlowNetwork& network) {
  std::vector<std::string> names;
  for (const FlowJoint& joint : network.joints) names.push_back(joint.name);
  return distinct(names, openFoamWord);
}

/// `systems`: of the branches of the network's tree; none if unknown.
Json vesselJson(const FlowNetwork& network, std::size_t s, const std::string& name,
                const std::vector<std::string>& joints,
                const std::vector<formats::VesselSystem>& systems) {
  const FlowSegment& segment = network.segments[s];
  const Lumped values = lumped(segment);
  Json vessel = {{"vessel_id", s},
                 {"vessel_name", name},
                 {"vessel_length", kCentimetres * segment.length()},
                 {"zero_d_element_type", "BloodVessel"},
                 {"zero_d_element_values",
                  {{"R_poiseuille", kCgsResistance * values.resistance},
                   {"C", kCgsCompliance * values.compliance},
                   {"L", kCgsInertance * values.inertance},
                   {"stenosis_coefficient", 0.0}}},
                 {"_label", segment.name}};
  if (!systems.empty()) vessel["_system"] = systemName(systems[segment.branch]);
  Json ends = Json::object();
  if (network.joints[segment.from].kind == JointKind::Inlet) ends["inlet"] = joints[segment.from];
  if (network.joints[segment.to].kind == JointKind::Outlet) ends["outlet"] = joints[segment.to];
  if (!ends.empty()) vessel["boundary_conditions"] = std::move(ends);
  return vessel;
}

Json conditionsJson(const FlowNetwork& network, const std::vector<std::string>& names) {
  Json list = Json::array();
  for (const FlowTree& tree : network.trees) {
    for (const std::uint32_t inlet : tree.inlets) {
      const double flow = kCgsFlow * network.joints[inlet].inflow;
      list.push_back({{"bc_name", names[inlet]},
                      {"bc_type", "FLOW"},
                      {"bc_values", {{"Q", {flow, flow}}, {"t", {0.0, 1.0}}}},
                      {"_place", placeJson(network, inlet)}});
    }
    const std::vector<double> resistances = outletResistances(network, tree);
    for (std::size_t k = 0; k < resistances.size(); ++k)
      list.push_back({{"bc_name", names[tree.outlets[k]]},
                      {"bc_type", "RESISTANCE"},
                      {"bc_values", {{"R", kCgsResistance * resistances[k]}, {"Pd", 0.0}}},
                      {"_place", placeJson(network, tree.outlets[k])}});
  }
  return list;
}

Json makeModel(const FlowNetwork& network, const std::vector<formats::VesselSystem>& systems) {
  const std::vector<std::string> joints = jointNames(network), vessels = vesselNames(network);
  Json junctions = Json::array(), list = Json::array();
  for (std::size_t j = 0; j < network.joints.size(); ++j) {
    const FlowJoint& joint = network.joints[j];
    if (joint.kind != JointKind::Junction) continue;
    junctions.push_back({{"junction_name", joints[j]},
                         {"junction_type", "NORMAL_JUNCTION"},
                         {"inlet_vessels", joint.in},
                         {"outlet_vessels", joint.out}});
  }
  for (std::size_t s = 0; s < network.segments.size(); ++s)
    list.push_back(vesselJson(network, s, vessels[s], joints, systems));
  return {{"description",
           {{"units", "cm, g, s, dyn"},
            {"density", 1e-3 * blood::kDensity},
            {"viscosity", 10 * blood::kViscosity},
            {"mean_velocity", 100 * blood::kMeanVelocity},
            {"mean_pressure", 10 * blood::kMeanPressure}}},
          {"simulation_parameters",
           {{"number_of_cardiac_cycles", kCycles}, {"number_of_time_pts_per_cardiac_cycle", 101}}},
          {"boundary_conditions", conditionsJson(network, joints)},
          {"vessels", std::move(list)},
          {"junctions", std::move(junctions)}};
}

}  // namespace

ExportResult exportSvZeroD(const ExportInput& input) {
  const std::vector<StatedInlet> inlets = statedInlets(input.options.inlets, input.options.word);
  FlowCase flowing = flowCase(input.source, inlets, input.options.word, input.options.keepEnds);
  const FlowNetwork network = flowNetwork(flowing.value.tree, inlets);
  ExportResult result;
  result.start = exportText("svzerod/README.md");
  result.files = {{"model.json",
                   makeModel(network, formats::knownBranchSystems(flowing.value))
                           .dump(2, ' ', false, Json::error_handler_t::replace) +
                       "\n",
                   "vessels, junctions, inlets and outlets", ""}};
  result.ends = findEnds(network);
  result.losses = std::move(flowing.losses);
  result.losses.insert(result.losses.end(), network.messages.begin(), network.messages.end());
  addOutlets(network, result);
  result.remarks = {networkSummary(network)};
  return result;
}

TargetRow svZeroDRow() {
  return {.name = "svzerod",
          .title = "svZeroDSolver",
          .files = {"model.json"},
          .units = {LengthUnit::Centimetre},
          .axes = {Axes::Lps},
          .holds =
              "lengths, radii, junctions and loops, as resistance, compliance and inertance of "
              "each segment",
          .lacks = "aneurysms; the shape of sections",
          .options = {"inlets", "keep-ends"},
          .needsModels = false};
}

}  // namespace lumen::convert
