// SPDX-License-Identifier: Apache-2.0
// A case as a project of SimVascular.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// vessels.svproj, Paths/NAME.pth and Segmentations/NAME.ctgr of each branch, with circles at its
/// nodes, about a radius apart, Models/vessel.mdl and .vtp, and, if TetGen is installed,
/// mesh-complete, all in cm, LPS. Throws as lumenSurface() and branchPaths().
ExportResult exportSimVascular(const ExportInput& input);

TargetRow simVascularRow();

}  // namespace lumen::convert
