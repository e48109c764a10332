// SPDX-License-Identifier: Apache-2.0
// The texts of a case of OpenFOAM.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "converters/export/shared/target.h"
#include "converters/export/targets/openfoam/foam_patches.h"

namespace lumen::convert {

/// Values that the dictionaries state. Lengths are in m.
struct FoamCase {
  std::vector<FoamPatch> patches;
  FoamBlock block;
  int layers = 0;
  std::vector<Eigen::Vector3d> inside;  ///< a point in each connected part
  FoamFlow flow = FoamFlow::Steady;
};

/// Allrun and all dictionaries.
std::vector<ExportFile> foamDictionaries(const FoamCase& foam);

/// Rows of each end: name, kind, m^3/s, Pa above the outlet that holds the pressure, by Poiseuille.
std::string expectedTable(const std::vector<FoamPatch>& patches);

}  // namespace lumen::convert
