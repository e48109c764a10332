// SPDX-License-Identifier: Apache-2.0
// Vessels of label maps where the volume beside them shows no wall.
#pragma once

#include <vector>

#include "converters/operations/context.h"
#include "converters/operations/source.h"
#include "converters/stages/finding/find_vessels.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// The trees of the vessels that maps state, by the surfaces of their labels, one case for each map
/// that has any, and of which vessels fill a tenth at most; mm, LPS. Throws Error(Cancelled).
std::vector<formats::Case> statedVessels(const std::vector<LabelPart>& maps,
                                         const Context& context);

/// Adds to a case that was found in a volume the stretches of stated vessels that it lacks, where
/// most of their axis is lumen by its level, or is no bone for a false lumen: there the volume has
/// no wall that a cylinder would fit, as beside bone. Each hangs on the vessel of its system that it
/// touches. Their walls are the maps', as
/// coarse as these, and their nodes are given. A stretch that is shorter than it, or the vessel
/// beside it, is wide, is a bump of the map. Returns the number of branches added.
std::size_t addStatedVessels(const std::vector<formats::Case>& stated,
                             const convert::FoundVessels& found, formats::Case& target);

}  // namespace lumen::operations
