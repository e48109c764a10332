// SPDX-License-Identifier: Apache-2.0
// The parts of a case that the page shows.
#pragma once

#include <string>
#include <string_view>

#include "converters/base/progress.h"
#include "formats/case/case.h"

namespace lumen::viewer {

/// The pack `case` of a valid case (viewer/README.md), with its wall points or without. Throws
/// Error(Cancelled).
std::string casePack(const formats::Case& value, bool withPoints, Progress& progress);

// Packs for the page as one file, where every byte is carried along.

/// The surface or mesh in fewer bytes (viewer/README.md, "Packs"): triangles of a part and
/// vertices in another order, positions in 65,535 steps along each axis of their box, radii in 4095
/// steps of their range. Takes a pack as surfacePack() and meshPack() make them.
std::string compactPack(std::string_view pack);

/// The distances of a mesh's vertices (viewer/README.md, "Packs", `deviation`) in the order of
/// compactPack() of the mesh, in 65,535 steps of their range. Takes packs as meshPack() and
/// deviationPack() make them.
std::string compactDistances(std::string_view mesh, std::string_view distances);

/// Bytes as zlib has them (RFC 1950). Throws Error(Failed) where there is no memory.
std::string deflated(std::string_view bytes);

}  // namespace lumen::viewer
