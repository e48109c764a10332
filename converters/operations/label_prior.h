// SPDX-License-Identifier: Apache-2.0
// Label maps beside a grey volume as knowledge about its voxels.
#pragma once

#include <vector>

#include "converters/base/progress.h"
#include "converters/operations/source.h"
#include "converters/stages/finding/find_vessels.h"
#include "converters/stages/finding/prior.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// The statements of maps about the voxels of a volume, by positions; of several about a voxel that
/// of the first map counts that has a lumen there. Vessels without a system, arteries, aneurysms and true lumens are one
/// system, veins another, false lumens a third. Chambers of the heart, tissue and what lies outside
/// of all regions, if there are any, are no vessel, but where their role is a guess from a name;
/// labels of unknown roles say nothing. Empty if
/// no map says anything. Throws Error(Cancelled).
convert::Prior priorOf(const std::vector<LabelPart>& maps, const convert::VolumeGeometry& geometry,
                       const Progress& progress);

/// Gives each branch of a case the system of the lumen that most of its nodes lie in; those of the
/// prior's first system are arteries. Changes nothing if a prior stated none.
void setSystemsOf(const convert::FoundVessels& found, formats::Case& value);

}  // namespace lumen::operations
