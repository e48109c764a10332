// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/openfoam/foam_dictionaries.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

#include "converters/base/number_text.h"
#include "converters/export/shared/blood.h"
#include "converters/export/shared/export_text.h"
#include "converters/export/targets/openfoam/waveform.h"

namespace lumen::convert {

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

ExportFile allrun(FoamFlow flow) {
  ExportFile file{
      "Allrun",
      exportText("openfoam/Allrun", {{"solver", solverOf(flow)},
                                     {"verdict", exportText(flow == FoamFlow::Steady
                                                                ? "openfoam/verdict-steady"
                                                                : "openfoam/verdict-pulsatile")}}),
      "makes the mesh, runs the flow, writes `wall-TIME.vtp`", ""};
  file.isProgram = true;
  return file;
}

}  // namespace

std::vector<ExportFile> foamDictionaries(const FoamCase& foam) {
  const bool isSteady = foam.flow == FoamFlow::Steady;
  std::vector<ExportFile> files = {
      allrun(foam.flow),
      {"system/blockMeshDict", blockMeshDict(foam.block), "cubes around the vessels", ""},
      {"system/surfaceFeatureExtractDict", exportText("openfoam/surfaceFeatureExtractDict"),
       "the rims of flat ends", ""},
      {"system/snappyHexMeshDict", snappyHexMeshDict(foam), "the mesh of the inside", ""},
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

}  // namespace lumen::convert
