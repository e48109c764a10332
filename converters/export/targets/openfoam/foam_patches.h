// SPDX-License-Identifier: Apache-2.0
// Patches of a mesh of OpenFOAM, and the flows through them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/export/shared/flow_outlets.h"
#include "converters/export/shared/insertion.h"
#include "converters/export/shared/network.h"
#include "converters/export/shared/target.h"
#include "converters/export/targets/openfoam/openfoam_cells.h"
#include "converters/io/mesh/surface_mesh.h"

namespace lumen::convert {

/// A group of faces as a patch of the mesh.
struct FoamPatch {
  std::string end;                 ///< name of the group
  std::string name;                ///< as OpenFOAM takes it
  FaceKind kind = FaceKind::Wall;  ///< an end that is not flat is a wall
  double radius = 0;               ///< mm, of an end
  double calibre = 0;              ///< mm, of an outlet: endCalibre()
  int level = 0;                   ///< halvings of cells there
  double flow = 0;                 ///< m^3/s, in or out
  bool holdsPressure = false;      ///< an outlet of pressure 0, through which the rest flows
  double drop = 0;                 ///< Pa, by Poiseuille: above the outlet that holds pressure
};

/// Divides the wall of a surface into groups by the levels that `cells` has for its radii: the first
/// stays "wall", further ones are "wall-2", ... `scale`: units of the surface in a millimetre. Returns
/// the level of each group; an end has the finest one of its triangles.
std::vector<int> divideWall(SurfaceMesh& mesh, const FoamCells& cells, double scale);

/// A patch for each group of faces. Ends that are not flat are walls.
std::vector<FoamPatch> foamPatches(const SurfaceMesh& mesh, const std::vector<int>& levels,
                                   const std::vector<NamedEnd>& ends);

/// Sets flows and drops: each connected part of the network takes in the flows of its inlets, and its
/// outlets share them by blood::murrayShare() of endCalibre(); the widest one holds the pressure.
/// Inlets without an outlet, and outlets without an inlet, become walls, for which a sentence is
/// returned. Throws Error(InvalidInput) if nothing flows.
std::vector<std::string> assignFlows(std::vector<FoamPatch>& patches, const FlowNetwork& network);

/// The outlets of patches that have their flows, under the names of these.
std::vector<OutletRow> outletRows(const std::vector<FoamPatch>& patches,
                                  const FlowNetwork& network);

// The texts of a case of OpenFOAM.

/// Values that the dictionaries state. Lengths are in m.
struct FoamCase {
  std::vector<FoamPatch> patches;
  FoamBlock block;
  int layers = 0;
  std::vector<Eigen::Vector3d> inside;  ///< a point in each connected part
  FoamFlow flow = FoamFlow::Steady;
  bool isMeshed = false;  ///< constant/polyMesh is there: block, layers and inside do not count
};

/// Allrun and all dictionaries.
std::vector<ExportFile> foamDictionaries(const FoamCase& foam);

/// Rows of each end: name, kind, m^3/s, Pa above the outlet that holds the pressure, by Poiseuille.
std::string expectedTable(const std::vector<FoamPatch>& patches);

// The flow through an artery over a cycle of the heart.

/// s: the period of the waveform.
inline constexpr double kCycle = 1.1;

/// Flow of the common carotid artery at a time, in s, over its mean: 1 in the mean. Boileau et al., A
/// benchmark study of numerical schemes for one-dimensional arterial blood flow modelling, Int J
/// Numer Meth Biomed Eng 31, 2015: a Fourier series with a mean of 6.5 ml/s, of which harmonics above
/// the eleventh, below 0.3 % of it, are left out.
double carotidFlow(double time);

}  // namespace lumen::convert
