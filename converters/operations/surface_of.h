// SPDX-License-Identifier: Apache-2.0
// The surface of a case as triangles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/base/warning.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/operations/context.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/surface/patches/polygonise.h"
#include "formats/case/case.h"

namespace lumen::operations {

struct SurfaceOptions {
  /// As few triangles as the usual error allows; its levels count for patches, too.
  convert::ClosedSurfaceOptions closed = convert::ClosedSurfaceOptions::withFewTriangles();
  bool isInPatches = false;            ///< pieces of the nodes that meet but are not joined
  convert::PolygoniseOptions patches;  ///< of a surface in patches
};

struct Surface {
  /// The surface, and coarser ones behind it, all with the same groups and labels; mm, LPS.
  std::vector<convert::SurfaceMesh> levels;
  std::optional<convert::SurfaceReport> report;  ///< of a closed surface
};

/// The surface of a case with models: closed, one 2-manifold for each connected tree, or in patches.
/// Warns, with `name` first, of parts that it lacks and of places to look at. Takes seconds, on all
/// threads. Throws Error(InvalidInput) for a case without models and for cells or edges that would
/// not fit into memory, Error(Usage) for options that do not go together, and Error(Cancelled).
Surface surfaceOf(const formats::Case& value, const SurfaceOptions& options,
                  const std::string& name, const Context& context);

/// Parts that a user should look at: ends that are not flat, stretches of branches without a surface,
/// vessels that had to be opened or cut, triangles that pass through each other. Places where the
/// lumen of `value` runs into itself are left out once they are accepted.
std::vector<Warning> surfaceWarnings(const convert::SurfaceReport& report,
                                     const formats::Case& value, const Context& context);

/// The reason why places where the lumen of a case runs into itself may stay cut, if a person gave
/// one and nothing was done with the case since.
std::optional<std::string> acceptedContacts(const formats::Metadata& metadata);

/// Records that reason. Throws Error(Usage) for one without a letter, and as addStep().
void acceptContacts(formats::Metadata& metadata, const std::string& reason);

/// Warns of branches that have no surface in the patches called `name`, and of those with holes:
/// where cells of `cell` mm were too coarse for them, with cells that would do.
void warnOfLosses(const convert::Patches& patches, const std::string& name, double cell,
                  const Context& context);

}  // namespace lumen::operations
