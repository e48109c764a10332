// SPDX-License-Identifier: Apache-2.0
// A case as a folder that SOFA runs: scene.scn, scene.py, vessel.obj, case.lumen.
#pragma once

#include "converters/export/shared/target.h"
#include "converters/export/targets/sofa/sofa_options.h"

namespace lumen::convert {

/// The files, in mm and LPS. Throws as findInsertion() and lumenSurface().
ExportResult exportSofa(const ExportInput& input, const SofaOptions& options);

TargetRow sofaRow();

}  // namespace lumen::convert
