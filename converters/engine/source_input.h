// SPDX-License-Identifier: Apache-2.0
// Files as sources of cases: what the user states of them, and their values.
#pragma once

#include <string>

#include "converters/base/progress.h"
#include "converters/engine/centerline_input.h"
#include "converters/engine/file_format.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_input.h"
#include "converters/engine/stage_options.h"
#include "converters/operations/source.h"

namespace lumen::engine {

/// The user's statements about a file that a case is made of.
struct SourceArguments {
  VolumeArguments volume;
  CenterlineArguments centerline;
  MeshArguments mesh;
  MaskArguments mask;
};

/// The volume, mesh or centerline in `file`, or in bytes, with the parts beside it that the arguments name. A
/// volume holds labels if the arguments state it, or if there are no seeds for it and its voxels
/// show it. Assumptions of readers become warnings, and so do reasons to doubt voxels that seeds lie
/// in. Throws Error(InvalidInput) and Error(Unsupported) as the readers.
operations::Source loadSource(const InputFile& file, const FileFormat& format,
                              const SourceArguments& arguments, bool isSeeded, Progress& progress);

}  // namespace lumen::engine
