// SPDX-License-Identifier: Apache-2.0
// A case as a scene of 3D Slicer.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// scene.mrml, which opens the rest: vessels.vtp, centerlines/NAME.mrk.json (a Markups curve with
/// radii for each branch), seeds.mrk.json (a control point for each branch, as lumen track reads
/// it) and ends.mrk.json. All in mm and LPS, which each file states. Throws as lumenSurface().
ExportResult exportSlicer(const ExportInput& input);

TargetRow slicerRow();

}  // namespace lumen::convert
