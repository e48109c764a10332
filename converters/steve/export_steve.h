// SPDX-License-Identifier: Apache-2.0
// A case as the folder that stEVE, a learning environment for catheters, reads: paths and meshes as of
// SimVascular, and a Python module that makes its vessel tree with radii.
#pragma once

#include <string>
#include <vector>

#include "converters/common/named_file.h"
#include "converters/common/progress.h"
#include "converters/surface/closed_surface.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct SteveExport {
  std::vector<NamedFile> files;
  SurfaceReport surface;
};

/// Paths/NAME.pth of each branch and Meshes/vessel.vtp, in centimetres, as its class VMR scales them;
/// vessel.obj and vessels.py, in mm, for its class FromMesh; README.md. Positions are LPS, as in the case.
/// The mesh of the .obj looks into the lumen, where the instruments are: stEVE does not turn it. The case is
/// valid and has a vessel. Throws as closedSurface(), and Error(InvalidInput) for a case without a vessel.
SteveExport exportSteve(const formats::Case& source, const ClosedSurfaceOptions& surface,
                        Progress& progress);

}  // namespace lumen::convert
