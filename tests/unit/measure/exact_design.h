// SPDX-License-Identifier: Apache-2.0
// The design of a phantom as a case: exact nodes and exact wall points, fitted.
#pragma once

#include "converters/stages/phantom/design.h"
#include "formats/case/case.h"

namespace lumen::convert::test {

/// Every node of the design that lies `spacing` radii after the one before, with the places where
/// rays in even directions meet the wall within 2.4 radii, and fitted models. `voxel`: mm.
formats::Case caseOfDesign(const Design& design, double spacing, double voxel);

}  // namespace lumen::convert::test
