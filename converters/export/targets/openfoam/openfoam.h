// SPDX-License-Identifier: Apache-2.0
// A case as a case of OpenFOAM: the mesh of the inside and a steady, laminar flow.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// Case in metres: constant/triSurface/vessel.stl with a solid for each end, dictionaries for
/// blockMesh, snappyHexMesh and simpleFoam, and Allrun. Inlets get the mean flow of blood.h,
/// outlets a pressure of 0; an end that is not flat is wall. Throws as lumenSurface(), and
/// Error(InvalidInput) for a surface without a flat inlet or a flat outlet.
ExportResult exportOpenFoam(const ExportInput& input);

TargetRow openFoamRow();

}  // namespace lumen::convert
