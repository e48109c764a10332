// SPDX-License-Identifier: Apache-2.0
// Fit of the changed part of a case that is fitted already (docs/method.md, section 11).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/fitting/fit_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

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
