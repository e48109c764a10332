// SPDX-License-Identifier: Apache-2.0
// A case as a folder that SOFA runs: scene.scn, scene.py, vessel.obj, case.lumen, README.md.
#pragma once

#include <vector>

#include "converters/common/named_file.h"
#include "converters/common/progress.h"
#include "converters/sofa/scene.h"
#include "converters/surface/closed_surface.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct SofaExport {
  std::vector<NamedFile> files;
  Insertion insertion;
  int steps = 0;           ///< time steps that the insertion takes
  double gridSpacing = 0;  ///< mm; 0 without a grid
  SurfaceReport surface;   ///< of vessel.obj
};

/// The files, in mm and LPS. The case is valid. Throws as insertionOf() and closedSurface().
SofaExport exportSofa(const formats::Case& source, const SofaOptions& options,
                      const ClosedSurfaceOptions& surface, Progress& progress);

}  // namespace lumen::convert
