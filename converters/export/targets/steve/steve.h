// SPDX-License-Identifier: Apache-2.0
// A case as the folder that stEVE, a learning environment for catheters, reads: paths and meshes as
// of SimVascular, and a Python module that makes its vessel tree with radii.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// Paths/NAME.pth of each branch and Meshes/vessel.vtp, in centimetres, as its class VMR scales
/// them; vessel.obj and vessels.py, in mm, for its class FromMesh. Positions are LPS, as in the
/// case. The mesh of the .obj looks into the lumen, where the instruments are: stEVE does not turn
/// it. Throws as lumenSurface().
ExportResult exportSteve(const ExportInput& input);

TargetRow steveRow();

}  // namespace lumen::convert
