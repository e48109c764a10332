// SPDX-License-Identifier: Apache-2.0
// Vessels that the labels of a volume mark or name.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "converters/operations/context.h"
#include "converters/operations/source.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Tree and wall points of the `chosen` labels, all but 0 if it is empty; mm, LPS. A branch has the
/// name of its label where there are several, or names are known. Throws Error(InvalidInput) for
/// voxels that are no labels, and for labels that are no vessels; and Error(Cancelled).
formats::Case labelledVessels(const LabelPart& labels, const std::set<std::int64_t>& chosen,
                              const Context& context);

/// Names the branches of a case by the labels on which they lie, and gives the remarks on `ends`
/// the names that their branches have then. Where several maps have a label, that of the first
/// counts. A label that a table or a person states to be no vessel, or a region, names none.
/// `geometry` is that of the volume that the case was made of, which messages call `named`. Warns
/// of a map on which no branch lies. Throws Error(InvalidInput) for voxels that are no labels, or
/// lie elsewhere.
void nameByMaps(const std::vector<LabelPart>& maps, const convert::VolumeGeometry& geometry,
                const std::string& named, formats::Case& target,
                std::vector<convert::TrackEnd>& ends, const Context& context);

}  // namespace lumen::operations
