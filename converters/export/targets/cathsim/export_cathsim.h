// SPDX-License-Identifier: Apache-2.0
// A case as a phantom of CathSim, a learning environment for guidewires on MuJoCo.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// phantom_assets/vessel.xml and, below phantom_assets/meshes/vessel, visual.stl, simplified.stl
/// and hull_N.stl: the wall in convex pieces (wall_prisms.h). Metres. Throws as lumenSurface().
ExportResult exportCathsim(const ExportInput& input);

TargetRow cathsimRow();

}  // namespace lumen::convert
