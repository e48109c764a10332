// SPDX-License-Identifier: Apache-2.0
// A case as solids for 3D printers.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// wall.stl and wall.3mf, a solid wall around the lumen that is open at the ends, and core.stl and
/// core.3mf, the lumen as a solid; mm. README.md states the least thickness of the wall and where
/// it is. Throws as lumenSurface() and wallSurface().
ExportResult exportPrint(const ExportInput& input);

TargetRow printRow();

}  // namespace lumen::convert
