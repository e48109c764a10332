// SPDX-License-Identifier: Apache-2.0
// Local implicit modelling: a blobby model for every centerline node (thesis chapter 4; design
// notes section 2).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// Defaults are those of thesis table 4.5. The lengths marked * are tied to a 0.2 mm voxel there;
/// left empty, they scale with the case's voxel size.
struct FitOptions {
  formats::Kernel kernel = formats::Kernel::Cauchy;
  std::optional<double> kernelParameter;  ///< Cauchy s^2 (1/5), Gaussian a^2 (1/2)
  double cohesionWeight = 1e-5;           ///< alpha, of the Lennard-Jones energy
  double curvatureWeight = 1e-3;          ///< beta, of the mean-curvature energy
  double cohesionScale = 2.0;             ///< s, of the Lennard-Jones energy
  int maxSubdivisions = 100;              ///< N_s, at most 1000
  int neighbourhood =
      2;               ///< topological distance of the nodes whose points are fitted, at most 100
  int seamSweeps = 3;  ///< joint refinements of adjacent models, at most 100
  double seamWeight = 64;          ///< of a node's seams in E_d, in the weight of all of its points
  std::optional<double> isoLevel;  ///< T, mm *: half a voxel
  std::optional<double> accuracy;  ///< t_g, mm *: 1.5 voxels
  std::optional<double> maxDistance;  ///< farther blobs are dropped, mm from the node *: 100 voxels
  std::optional<double> minWidth;     ///< narrower blobs are dropped, mm *: 0.1 voxel

  /// The same with every optional value set. Throws Error(InvalidInput) for values out of range.
  [[nodiscard]] FitOptions resolved(double voxelSize) const;
  /// Every value by its option's name, as a case stores it.
  [[nodiscard]] std::map<std::string, formats::ParameterValue> parameters() const;
};

/// The thesis' algorithm on the same energy, with these differences, each for accuracy on narrow or
/// noisy vessels: E_d measures distances rather than differences of the field (energy.h); beta
/// falls with the fourth power of the radius below ten voxels, and once there is an estimate of the
/// noise, follows its variance, and the curvature is expected to be even, not small; the widths of
/// a model's blobs are expected to differ by a tenth; all unknowns move together, by
/// Levenberg-Marquardt steps; a new blob stays only if it lowers the energy by enough, and blobs
/// are added beyond the accuracy asked for while they do, up to a twentieth of the node's radius;
/// the centre of every blob stays in the lumen, within the radius of a node of the neighbourhood; a
/// fit that leaves the points far away is tried again from blobs all over that lumen;
/// and afterwards adjacent models are refined together: in every sweep each pair gets points on its
/// radical plane, halfway between the two surfaces, and all models are minimised with those points.
///
/// Adds (or replaces) the blobby models of a case that has wall points, and appends the "fit" step
/// to its metadata. Nodes whose neighbourhood has too few points get the two starting blobs. The
/// result does not depend on the number of threads. Throws Error(InvalidInput) if the case has no
/// points or no voxel size while a voxel-scaled option is left empty, and Error(Cancelled).
void fit(formats::Case& target, const FitOptions& options, Progress& progress);

}  // namespace lumen::convert
