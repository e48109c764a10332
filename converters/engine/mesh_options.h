// SPDX-License-Identifier: Apache-2.0
// Rows of the options of a case's surface and of mesh files.
#pragma once

#include "converters/base/options/option_table.h"
#include "converters/engine/file_format.h"
#include "converters/stages/surface/closing/closed_surface.h"

namespace lumen::engine {

/// The closed surface: edges, flow extensions, a wall, error or number of triangles.
void addSurfaceRows(OptionTable& table, convert::ClosedSurfaceOptions& surface);

/// Layers of prisms of a volume mesh.
void addLayerRows(OptionTable& table, convert::VolumeMeshOptions& cells);

/// Rows for writing a mesh by `lumen convert`: the surface, its patches, and the file's own
/// options.
void addMeshFileRows(OptionTable& table, OutputOptions& output);

}  // namespace lumen::engine
