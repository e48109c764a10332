// SPDX-License-Identifier: Apache-2.0
// Local implicit modelling: a blobby model for every centerline node (docs/method.md,
// section 2; Yureidini's thesis, chapter 4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/fitting/fit_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// The thesis' algorithm on the same energy, with these differences, each for accuracy on narrow or
/// noisy vessels:
///
/// - E_d measures distances rather than differences of the field (energy.h);
/// - beta falls with the fourth power of the radius below ten voxels, and once there is an estimate
///   of the noise, follows its variance; and the curvature is expected to be even, not small;
/// - the widths of a model's blobs are expected to differ by a tenth;
/// - all unknowns move together, by Levenberg-Marquardt steps;
/// - a new blob stays only if it lowers the energy by enough, and blobs are added beyond the
///   accuracy asked for while they do, up to a twentieth of the node's radius;
/// - the centre of every blob stays in the lumen, within the radius of a node of the neighbourhood;
/// - a fit that leaves the points far away is tried again from blobs all over that lumen;
/// - afterwards adjacent models are refined together: in every sweep each pair gets points on its
///   radical plane, halfway between the two surfaces, and all models are minimised with those
///   points.
///
/// Adds (or replaces) the blobby models of a case that has wall points, and appends the "fit" step
/// to its metadata. Nodes whose neighbourhood has too few points get the two starting blobs. The
/// result does not depend on the number of threads. Throws Error(InvalidInput) if the case has no
/// points or no voxel size while a voxel-scaled option is left empty, and Error(Cancelled).
void fit(formats::Case& target, const FitOptions& options, Progress& progress);

// Fit of the changed part of a case that is fitted already (docs/method.md, section 11).

/// The options that a case was fitted with, by its last "fit" step and its models; defaults for
/// values that this step lacks or has wrong.
FitOptions recordedFitOptions(const formats::Case& value);

/// Fits some nodes of a case that has models and wall points as fit() does, and brings their
/// surfaces to those of their neighbours, whose models stay bit for bit. Edges near by along which
/// a tool could no longer be pushed are opened, which may add a blob to a neighbour. `nodes`:
/// indices in any order. Kernel and iso-level are those of the case's models, not of the options.
/// Adds no step. The result does not depend on the number of threads. Throws Error(InvalidInput) if
/// the case has no models or no wall points or a node is not of the case, and Error(Cancelled); the
/// case is then as it was.
void refit(formats::Case& target, std::span<const std::uint32_t> nodes, const FitOptions& options,
           Progress& progress);

/// The nodes of `after`, ascending, for whose models the input of fit() differs from that for
/// `before`: wall points within as many edges as the case's fit looks, centres, radii, and edges.
/// `nodeBefore`: for each node of `after` its index in `before`, or UINT32_MAX for a new one, which
/// is among the result. Both cases are valid. A reversed direction makes no difference.
std::vector<std::uint32_t> staleNodes(const formats::Case& before, const formats::Case& after,
                                      std::span<const std::uint32_t> nodeBefore);

}  // namespace lumen::convert
