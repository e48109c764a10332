// SPDX-License-Identifier: Apache-2.0
// Facts of a volume for `lumen info`.
#pragma once

#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/label_answer.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/voxels/volume.h"

namespace lumen::engine {

struct VolumeInfo {
  convert::VolumeHeader header;
  struct Values {
    std::string pixelType;  ///< in memory: uint8, int16, uint16 or float32
    double min = 0, max = 0;
    std::string sha256;
    CountedLabels labels{};  ///< empty for grey values
  };
  std::optional<Values> values;  ///< empty: the voxels were not read
};

VolumeInfo describeVolume(const convert::VolumeHeader& header, const convert::Volume& volume,
                          Progress& progress);

/// size, spacing_mm, origin_mm, direction (row-major), stored_type, encoding, voxel_bytes,
/// stored_bytes; if the voxels were read, sha256, pixel_type, min, max and labels.
Json volumeInfoJson(const VolumeInfo& info);
std::string volumeInfoText(const VolumeInfo& info);

/// The geometry and digest alone, as a case's provenance shows them.
Json sourceVolumeJson(const formats::SourceVolume& source);

}  // namespace lumen::engine
