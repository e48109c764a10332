// SPDX-License-Identifier: Apache-2.0
// The facts that `lumen info` gives of a volume.
#pragma once

#include <string>

#include "converters/app/report.h"
#include "converters/common/progress.h"
#include "converters/volume/volume.h"

namespace lumen::app {

struct VolumeInfo {
  formats::SourceVolume source;
  std::string pixelType;  ///< in memory: uint8, int16, uint16 or float32
  double min = 0, max = 0;
};

VolumeInfo describeVolume(const convert::Volume& volume, Progress& progress);

/// size, spacing_mm, origin_mm, direction (row-major), pixel_type, min, max, sha256.
Json volumeInfoJson(const VolumeInfo& info);
std::string volumeInfoText(const VolumeInfo& info);

/// The geometry and digest alone, as a case's provenance shows them.
Json sourceVolumeJson(const formats::SourceVolume& source);

}  // namespace lumen::app
