// SPDX-License-Identifier: Apache-2.0
// Rows of the options of a case's surface and of mesh files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/io/mesh/surface_mesh.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "formats/case/case.h"

namespace lumen::engine {

/// The closed surface: edges, flow extensions, a wall, simplification.
void addSurfaceRows(OptionTable& table, convert::ClosedSurfaceOptions& surface);

/// Rows for writing a mesh by `lumen convert`: the surface, its patches, and the file's own
/// options.
void addMeshFileRows(OptionTable& table, OutputOptions& output);

// The one place where a case becomes the surface that mesh formats write.

struct CaseMesh {
  /// The surface, and coarser ones behind it, all with the same groups and labels.
  std::vector<convert::SurfaceMesh> levels;
  std::optional<convert::SurfaceReport> report;  ///< report on a closed surface
};

/// The surface by the options; one level unless `hasLevels`. Warns of parts that the mesh in `file`
/// lacks.
CaseMesh meshOfCase(const formats::Case& value, const std::filesystem::path& file,
                    const OutputOptions& options, bool hasLevels, Progress& progress);

}  // namespace lumen::engine
