// SPDX-License-Identifier: Apache-2.0
// A case as a case of OpenFOAM: the mesh of the inside and a steady, laminar flow.
#pragma once

#include <cstdint>

#include "converters/export/shared/target.h"

namespace lumen::convert {

// Options of `lumen export openfoam` alone.

/// Cells of snappyHexMesh in three sizes, or prisms and tetrahedra, which lumen makes.
enum class FoamGrain : std::uint8_t { Coarse, Medium, Fine, Prisms };
enum class FoamFlow : std::uint8_t { Steady, Pulsatile };

struct FoamOptions {
  FoamGrain cells = FoamGrain::Medium;
  FoamFlow flow = FoamFlow::Steady;
};

/// Case in metres: constant/triSurface/vessel.stl with a solid for each end, dictionaries for
/// blockMesh, snappyHexMesh and the solver, Allrun, and the pressures that Poiseuille expects. Parts
/// without a path from an inlet, and ends that the cells cannot resolve, are left out; an end that is
/// not flat is wall. Inlets get the flows of flowNetwork(), which outlets share by murrayShare().
/// Throws as flowCase() and lumenSurface(), and Error(InvalidInput) for a surface that nothing can
/// flow through. With FoamGrain::Prisms, constant/polyMesh holds the cells of lumenCells(), no end is left
/// out, and it throws as that does.
ExportResult exportOpenFoam(const ExportInput& input, const FoamOptions& options);

TargetRow openFoamRow();

}  // namespace lumen::convert
