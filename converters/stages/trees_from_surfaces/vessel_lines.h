// SPDX-License-Identifier: Apache-2.0
// The courses of all vessels inside of a surface: found, or from a centerline of another program.
#pragma once

#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/centerline/centerline_file.h"
#include "converters/stages/trees_from_surfaces/vessel_line.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

struct VesselLines {
  std::vector<VesselLine> lines;   ///< parents first
  std::vector<std::string> notes;  ///< remarks for the user, a sentence each
};

/// The vessels of each connected part of the inside (docs/method.md, section 10): from its widest
/// flat end, or else from its widest tip. `grid` is that of insideGrid(). `allOpenings`: a line leads to
/// each opening, however short it is. Throws Error(Cancelled).
VesselLines findLines(const LumenGeometry& lumen, const VolumeGeometry& grid, bool allOpenings,
                      Progress& progress);

/// The chains of a centerline (mm, LPS), without their parts outside. Throws Error(InvalidInput),
/// `name` (of its file, printable) first, if less than half of its points lie inside; the message
/// reports if more would with x and y negated or in another unit.
VesselLines clipLines(const CenterlineFile& centerline, const std::string& name,
                      const LumenGeometry& lumen);

}  // namespace lumen::convert
