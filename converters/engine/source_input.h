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
  std::string frame;  ///< of a mesh or centerline: lps, ras, or empty
  MeshArguments mesh;
  MaskArguments mask;
  InputFile native{};  ///< the same body without contrast; may be empty
};

/// The volume, mesh or centerline in `file`, with the parts beside it that the arguments name.
/// Assumptions of readers become warnings. A volume is taken as by volumeSource(). Throws
/// Error(InvalidInput) and Error(Unsupported) as the readers.
operations::Source loadSource(const InputFile& file, const FileFormat& format,
                              const SourceArguments& arguments, bool isSeeded, Progress& progress);

/// A volume that was read from `file`, with the label map that the arguments name. It holds labels if
/// these state it, or if there are no seeds for it and its voxels show it; then it is settled
/// (settled_labels.h). `layer`: the volume of the file that was read. Reasons to doubt voxels
/// that seeds lie in become warnings. Throws Error(InvalidInput).
operations::Source volumeSource(convert::Volume volume, const InputFile& file,
                                const MaskArguments& mask, bool isSeeded, Progress& progress,
                                std::int64_t layer = 0);

}  // namespace lumen::engine
