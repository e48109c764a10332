// SPDX-License-Identifier: Apache-2.0
// Options of the fit.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "converters/base/options/option_table.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Defaults are those of Yureidini's thesis, table 4.5. The lengths marked * are tied to a 0.2 mm
/// voxel there; left empty, they scale with the case's voxel size.
struct FitOptions {
  formats::Kernel kernel = formats::Kernel::Cauchy;
  std::optional<double> kernelParameter;  ///< Cauchy s^2 (1/5), Gaussian a^2 (1/2)
  double cohesionWeight = 1e-5;           ///< alpha, of the Lennard-Jones energy
  double curvatureWeight = 1e-3;          ///< beta, of the mean-curvature energy
  double cohesionScale = 2.0;             ///< s, of the Lennard-Jones energy
  int maxSubdivisions = 100;              ///< N_s, at most 1000
  int neighbourhood = 2;   ///< topological distance of the nodes whose points count, at most 100
  int seamSweeps = 3;      ///< joint refinements of adjacent models, at most 100
  double seamWeight = 64;  ///< weight of a node's seams in E_d, in that of all of its points
  std::optional<double> isoLevel;     ///< T, mm *: half a voxel
  std::optional<double> accuracy;     ///< t_g, mm *: 1.5 voxels
  std::optional<double> maxDistance;  ///< farther blobs are dropped, mm from the node *: 100 voxels
  std::optional<double> minWidth;     ///< narrower blobs are dropped, mm *: 0.1 voxel

  /// Adds a row for each value above, stored in this object.
  void addRows(OptionTable& table);
  /// Copy of these options with every optional value set. Throws Error(InvalidInput) for values out
  /// of range.
  [[nodiscard]] FitOptions resolved(double voxelSize) const;
  /// The values that are set, by option name, as a case stores them.
  [[nodiscard]] std::map<std::string, formats::ParameterValue> parameters() const;
};

}  // namespace lumen::convert
