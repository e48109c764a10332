// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/foam_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/text_files.h"
#include "converters/io/mesh/mesh_parts.h"

namespace lumen::convert {

namespace {

/// Level of a triangle: that of the mean radius at its corners.
int levelOf(const SurfaceMesh& mesh, const Triangle& t, const FoamCells& cells, double scale) {
  double sum = 0;
  for (const std::uint32_t v : t) sum += static_cast<double>(mesh.radius[v]);
  return cells.level(sum / 3 / scale);
}

/// The ends of one connected part of the network.
struct FlowPart {
  std::vector<FoamPatch*> inlets, outlets;
  double flow = 0;  ///< m^3/s, of all inlets
};

FlowPart partOf(std::vector<FoamPatch>& patches, const FlowNetwork& network, const FlowTree& tree) {
  FlowPart part;
  for (FoamPatch& patch : patches) {
    const auto isAt = [&](std::uint32_t joint) { return network.joints[joint].name == patch.end; };
    if (patch.kind == FaceKind::Inlet)
      if (const auto at = std::find_if(tree.inlets.begin(), tree.inlets.end(), isAt);
          at != tree.inlets.end()) {
        patch.flow = network.joints[*at].inflow;
        part.flow += patch.flow;
        part.inlets.push_back(&patch);
      }
    if (patch.kind == FaceKind::Outlet)
      if (const auto at = std::find_if(tree.outlets.begin(), tree.outlets.end(), isAt);
          at != tree.outlets.end()) {
        patch.calibre = endCalibre(network, *at);
        part.outlets.push_back(&patch);
      }
  }
  return part;
}

/// Outlets share the flow of their part.
void share(FlowPart& part) {
  double shares = 0;
  for (const FoamPatch* outlet : part.outlets) shares += blood::murrayShare(outlet->calibre);
  FoamPatch* widest = part.outlets.front();
  for (FoamPatch* outlet : part.outlets) {
    outlet->flow = part.flow * blood::murrayShare(outlet->calibre) / shares;
    if (outlet->radius > widest->radius) widest = outlet;
  }
  widest->holdsPressure = true;
}

std::uint32_t jointOf(const FlowNetwork& network, const FoamPatch& patch) {
  std::uint32_t joint = 0;
  while (joint < network.joints.size() && network.joints[joint].name != patch.end) ++joint;
  return joint;
}

void setDrops(std::vector<FoamPatch>& patches, const FlowNetwork& network) {
  std::vector<double> into(network.joints.size(), 0.0);
  std::vector<std::uint32_t> zero;
  for (const FlowTree& tree : network.trees) zero.push_back(tree.outlets.front());
  for (const FoamPatch& patch : patches) {
    if (patch.flow == 0) continue;
    const std::uint32_t joint = jointOf(network, patch);
    into[joint] = patch.kind == FaceKind::Inlet ? patch.flow : -patch.flow;
    if (patch.holdsPressure) zero[network.joints[joint].tree] = joint;
  }
  const std::vector<double> pressures = pressuresOfFlows(network, into, zero);
  for (FoamPatch& patch : patches)
    if (patch.flow != 0 && !patch.holdsPressure) patch.drop = pressures[jointOf(network, patch)];
}

}  // namespace

std::vector<int> divideWall(SurfaceMesh& mesh, const FoamCells& cells, double scale) {
  std::map<int, std::uint32_t> groupOf;  // of the wall, by level
  std::vector<int> levels(mesh.groups.size(), 0);
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const int level = levelOf(mesh, mesh.triangle[t], cells, scale);
    const std::uint32_t group = mesh.group[t];
    if (mesh.groups[group].kind != FaceKind::Wall) {
      levels[group] = std::max(levels[group], level);
      continue;
    }
    const auto [at, isNew] = groupOf.emplace(level, group);
    if (isNew && groupOf.size() > 1) {
      at->second = static_cast<std::uint32_t>(mesh.groups.size());
      mesh.groups.push_back({"wall-" + std::to_string(groupOf.size()), FaceKind::Wall});
      levels.push_back(0);
    }
    mesh.group[t] = at->second;
    levels[at->second] = level;
  }
  return levels;
}

std::vector<FoamPatch> foamPatches(const SurfaceMesh& mesh, const std::vector<int>& levels,
                                   const std::vector<NamedEnd>& ends) {
  const std::vector<std::string> names = distinct(plainGroupNames(mesh.groups), openFoamWord);
  std::vector<FoamPatch> patches;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    if (std::find(mesh.group.begin(), mesh.group.end(), g) == mesh.group.end()) continue;
    FoamPatch patch;
    patch.end = mesh.groups[g].name;
    patch.name = names[g];
    patch.kind = mesh.groups[g].kind == FaceKind::Cap ? FaceKind::Wall : mesh.groups[g].kind;
    patch.level = levels[g];
    for (const NamedEnd& end : ends)
      if (end.name == patch.end) patch.radius = end.radius;
    patches.push_back(std::move(patch));
  }
  return patches;
}

std::vector<std::string> assignFlows(std::vector<FoamPatch>& patches, const FlowNetwork& network) {
  for (const FlowTree& tree : network.trees) {
    FlowPart part = partOf(patches, network, tree);
    if (!part.inlets.empty() && !part.outlets.empty())
      share(part);
    else
      for (FoamPatch* inlet : part.inlets) inlet->flow = 0;
  }
  std::vector<std::string> losses;
  bool flows = false;
  for (FoamPatch& patch : patches) {
    if (patch.kind == FaceKind::Wall) continue;
    flows = flows || patch.flow > 0;
    if (patch.flow > 0) continue;
    losses.push_back(patch.end + ": no flat " +
                     (patch.kind == FaceKind::Inlet ? "outlet" : "inlet") +
                     " is connected to this end, so it is a wall");
    patch.kind = FaceKind::Wall;
  }
  if (!flows)
    throw invalidInput(
        "the surface of this case has no flat inlet with a flat outlet behind it, so nothing can "
        "flow through it");
  setDrops(patches, network);
  return losses;
}

std::vector<OutletRow> outletRows(const std::vector<FoamPatch>& patches,
                                  const FlowNetwork& network) {
  constexpr double kMillilitres = 1e6;  // in a m^3
  std::vector<OutletRow> rows;
  std::vector<double> flows(network.trees.size(), 0.0);
  for (const FoamPatch& patch : patches) {
    if (patch.kind != FaceKind::Outlet) continue;
    const std::uint32_t joint = jointOf(network, patch);
    flows[network.joints[joint].tree] += kMillilitres * patch.flow;
    rows.push_back({joint, patch.name, patch.calibre, patch.radius, 0, kMillilitres * patch.flow,
                    patch.holdsPressure});
  }
  for (OutletRow& row : rows) row.share = row.flow / flows[network.joints[row.joint].tree];
  return rows;
}

namespace {

/// Most significant digits of a number in a dictionary of OpenFOAM.
constexpr int kFoamDigits = 12;
constexpr int kMostSteps = 1000;    // of a steady flow
constexpr int kHeartbeats = 2;      // of the heart: the first one fades away
constexpr int kTimesInCycle = 100;  // of the table of a waveform

std::string foamNumber(double value) {
  return numberText(value, kFoamDigits);
}

/// A vector of OpenFOAM, "(1 2.5 3)".
std::string foamVector(const Eigen::Vector3d& v) {
  return "(" + joinedNumbers(v, " ", kFoamDigits) + ")";
}

/// The programs that make the mesh.
constexpr const char* kSnappyMesh =
    "run surfaceFeatureExtract\nrun blockMesh\nrun snappyHexMesh -overwrite";

const char* solverOf(FoamFlow flow) {
  return flow == FoamFlow::Steady ? "simpleFoam" : "pimpleFoam";
}

std::string blockMeshDict(const FoamBlock& block) {
  const Eigen::Vector3d size = block.high - block.low;
  std::string vertices, counts;
  for (const auto& corner : std::initializer_list<Eigen::Vector3d>{
           {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}})
    vertices += "    " + foamVector(block.low + size.cwiseProduct(corner)) + "\n";
  for (const int n : block.count) counts += (counts.empty() ? "" : " ") + std::to_string(n);
  return exportText("openfoam/blockMeshDict", {{"vertices", vertices}, {"cells", counts}});
}

std::string snappyHexMeshDict(const FoamCase& foam) {
  std::string regions, refined, places;
  int least = foam.patches.front().level;
  for (const FoamPatch& patch : foam.patches) {
    const std::string level = std::to_string(patch.level);
    least = std::min(least, patch.level);
    regions += "            " + patch.name + " { name " + patch.name + "; }\n";
    refined += "                " + patch.name + " { level (" + level + " " + level +
               "); patchInfo { type " + (patch.kind == FaceKind::Wall ? "wall" : "patch") +
               "; } }\n";
  }
  for (const Eigen::Vector3d& p : foam.inside) places += " (" + foamVector(p) + " none)";
  return exportText(
      "openfoam/snappyHexMeshDict",
      {{"regions", regions},
       {"least", std::to_string(least)},
       {"layers", std::to_string(foam.layers)},
       {"refinements", refined},
       {"places", foam.inside.size() == 1 ? "locationInMesh " + foamVector(foam.inside.front())
                                          : "locationsInMesh (" + places + " )"}});
}

std::string controlDict(const FoamCase& foam) {
  std::string means, times;
  for (const FoamPatch& patch : foam.patches) {
    if (patch.kind == FaceKind::Wall) continue;
    for (const auto& [quantity, field, operation] :
         {std::array{"flow", "phi", "sum"}, {"pressure", "p", "areaAverage"}})
      means += exportText("openfoam/mean", {{"quantity", quantity},
                                            {"end", patch.name},
                                            {"field", field},
                                            {"operation", operation}});
  }
  if (foam.flow == FoamFlow::Steady)
    times = "endTime " + std::to_string(kMostSteps) +
            ";\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval " + std::to_string(kMostSteps) +
            ";";
  else
    times = "endTime " + numberText(kHeartbeats * kCycle) +
            ";\ndeltaT 1e-4;\nadjustTimeStep yes;\nmaxCo 20;\nmaxDeltaT " +
            numberText(kCycle / kTimesInCycle) + ";\nwriteControl adjustableRunTime;\n" +
            "writeInterval " + numberText(kCycle / 10) + ";";
  return exportText("openfoam/controlDict",
                    {{"solver", solverOf(foam.flow)}, {"times", times}, {"means", means}});
}

/// The value of volumetricFlowRate: a constant, or the waveform with this mean.
std::string flowText(double flow, FoamFlow kind) {
  if (kind == FoamFlow::Steady) return "constant " + foamNumber(flow);
  std::string values;
  for (int k = 0; k <= kHeartbeats * kTimesInCycle; ++k) {
    const double time = kCycle * k / kTimesInCycle;
    values += " (" + numberText(time) + " " + numberText(flow * carotidFlow(time)) + ")";
  }
  return "table (" + values + " )";
}

std::string velocity(const FoamCase& foam) {
  std::string ends;
  for (const FoamPatch& patch : foam.patches) {
    if (patch.kind == FaceKind::Wall)
      ends += "    " + patch.name + " { type noSlip; }\n";
    else if (patch.holdsPressure)
      ends += "    " + patch.name +
              " { type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0); }\n";
    else
      ends += "    " + patch.name + " { type flowRate" +
              (patch.kind == FaceKind::Inlet ? "Inlet" : "Outlet") +
              "Velocity; volumetricFlowRate " + flowText(patch.flow, foam.flow) +
              "; value uniform (0 0 0); }\n";
  }
  return exportText("openfoam/U", {{"ends", ends}});
}

std::string pressure(const std::vector<FoamPatch>& patches) {
  std::string ends;
  for (const FoamPatch& patch : patches)
    ends += "    " + patch.name +
            (patch.holdsPressure ? " { type fixedValue; value uniform 0; }\n"
                                 : " { type zeroGradient; }\n");
  return exportText("openfoam/p", {{"ends", ends}});
}

ExportFile allrun(const FoamCase& foam) {
  const bool isSteady = foam.flow == FoamFlow::Steady;
  ExportFile file{"Allrun",
                  exportText("openfoam/Allrun",
                             {{"mesh", foam.isMeshed ? "run renumberMesh -overwrite" : kSnappyMesh},
                              {"solver", solverOf(foam.flow)},
                              {"verdict", exportText(isSteady ? "openfoam/verdict-steady"
                                                              : "openfoam/verdict-pulsatile")}}),
                  "makes the mesh, runs the flow, writes `wall-TIME.vtp`", ""};
  file.isProgram = true;
  return file;
}

std::vector<ExportFile> snappyDictionaries(const FoamCase& foam) {
  return {{"system/blockMeshDict", blockMeshDict(foam.block), "cubes around the vessels", ""},
          {"system/surfaceFeatureExtractDict", exportText("openfoam/surfaceFeatureExtractDict"),
           "the rims of flat ends", ""},
          {"system/snappyHexMeshDict", snappyHexMeshDict(foam), "the mesh of the inside", ""}};
}

}  // namespace

std::vector<ExportFile> foamDictionaries(const FoamCase& foam) {
  const bool isSteady = foam.flow == FoamFlow::Steady;
  std::vector<ExportFile> files = {
      allrun(foam),
      {"system/controlDict", controlDict(foam),
       "steps; flow and pressure at ends, stress at the wall", ""},
      {"system/fvSchemes",
       exportText("openfoam/fvSchemes", {{"ddt", isSteady ? "steadyState" : "backward"},
                                         {"bounded", isSteady ? "bounded " : ""}}),
       "", ""},
      {"system/fvSolution", exportText("openfoam/fvSolution"), "", ""},
      {"constant/transportProperties",
       exportText("openfoam/transportProperties",
                  {{"viscosity", numberText(blood::kViscosity / blood::kDensity)}}),
       "blood", ""},
      {"constant/turbulenceProperties", exportText("openfoam/turbulenceProperties"), "", ""},
      {"constant/pascals.awk",
       exportText("openfoam/pascals.awk", {{"density", numberText(blood::kDensity)}}), "", ""},
      {"0/U", velocity(foam), "flows through ends", ""},
      {"0/p", pressure(foam.patches), "pressures at ends", ""}};
  if (!foam.isMeshed)
    for (ExportFile& file : snappyDictionaries(foam)) files.push_back(std::move(file));
  if (!isSteady)
    files.push_back({"constant/cycle.awk",
                     exportText("openfoam/cycle.awk", {{"period", numberText(kCycle)}}), "", ""});
  return files;
}

std::string expectedTable(const std::vector<FoamPatch>& patches) {
  std::string text = "end,kind,flow_m3_s,pressure_Pa\n";
  for (const FoamPatch& patch : patches)
    if (patch.kind != FaceKind::Wall)
      text += patch.name + (patch.kind == FaceKind::Inlet ? ",inlet," : ",outlet,") +
              numberText(patch.flow) + "," + numberText(patch.drop + 0.0) + "\n";
  return text;
}

namespace {

struct Harmonic {
  double flow;   ///< ml/s
  double phase;  ///< rad
};
constexpr double kMean = 6.5;  // ml/s
constexpr std::array<Harmonic, 11> kHarmonics = {{{3.294, -0.023974},
                                                  {1.9262, -1.1801},
                                                  {-1.4219, 0.92701},
                                                  {-0.66627, -0.24118},
                                                  {-0.33933, -0.27471},
                                                  {-0.37914, -1.0557},
                                                  {0.22396, 1.22},
                                                  {0.1507, 1.0984},
                                                  {0.18735, 0.067483},
                                                  {0.038625, 0.22262},
                                                  {0.012643, -0.10093}}};

}  // namespace

double carotidFlow(double time) {
  double flow = kMean;
  for (std::size_t n = 0; n < kHarmonics.size(); ++n)
    flow += kHarmonics[n].flow *
            std::sin(2 * std::numbers::pi * static_cast<double>(n + 1) * time / kCycle +
                     kHarmonics[n].phase);
  return flow / kMean;
}

}  // namespace lumen::convert
