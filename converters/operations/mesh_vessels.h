// SPDX-License-Identifier: Apache-2.0
// Vessels whose wall is a mesh.
#pragma once

#include <optional>
#include <string>

#include "converters/geometry/unit_guess.h"
#include "converters/operations/context.h"
#include "converters/operations/source.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Unit and axes that were taken for a mesh.
using MeshFrame = convert::ReadFrame;

/// The unit of a mesh of this size, called `name`, whose file states none. Warns where another unit
/// is plausible, too, where it is not mm, and where none is plausible.
convert::UnitGuess guessUnitOf(const convert::VesselSize& size, const std::string& name,
                               bool isOfSimVascular, const Context& context);

/// The unit of a mesh of this size, in its own unit, and its axes: as the option `unit`, mm, else its
/// file, else the standard of its format states it, else by its size. Warns as guessUnitOf(), and of a
/// size that is not possible by a standard.
MeshFrame meshFrame(const MeshPart& part, const convert::VesselSize& size, const std::string& name,
                    const std::optional<double>& unit, const Context& context);

/// Tree and wall points of the mesh of a source, along its centerline if it has one; mm, LPS.
/// `unit`: mm in one unit of the mesh, whatever its file states. Sets `frame`. Repairs and
/// assumptions become warnings. Throws Error(InvalidInput) for a mesh that is no surface of vessels,
/// and for a centerline that does not belong to it; and Error(Cancelled).
formats::Case meshVessels(const Source& source, const std::optional<double>& unit, MeshFrame& frame,
                          const Context& context);

}  // namespace lumen::operations
