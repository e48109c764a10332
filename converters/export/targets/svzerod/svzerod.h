// SPDX-License-Identifier: Apache-2.0
// A case as the input of svZeroDSolver, the blood flow solver of SimVascular without a dimension.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// model.json, in cgs (cm, g, s, dyn), as the solver's own examples: a BloodVessel with R, C and L
/// for each segment of flowNetwork(), junctions that share a pressure, the mean flow of blood.h at
/// inlets, outletResistances() at outlets. Loops are junctions like others. Throws as
/// flowNetwork().
ExportResult exportSvZeroD(const ExportInput& input);

TargetRow svZeroDRow();

}  // namespace lumen::convert
