// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/slurm_request.h"

#include <cmath>
#include <system_error>

#include "converters/base/error.h"
#include "converters/engine/file_format.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

// measured: docs/cohorts.md, "Memory and time of a row": with twice the memory, ten times the time
constexpr double kBaseMegabytes = 500, kBytesPerVoxel = 16;
constexpr double kBaseMinutes = 10, kMicrosecondsPerVoxel = 6;

/// Voxels of a volume as its header states them, before any crop.
double voxelsOf(const fs::path& input, const Progress& progress) {
  const FileFormat& format = inputFormat(input, "");
  if (format.readVolumeHeader == nullptr) return 0;
  const convert::VolumeHeader header = format.readVolumeHeader(input, {}, progress);
  return static_cast<double>(header.geometry.voxelCount());
}

}  // namespace

SlurmRequest requestFor(double voxels) {
  constexpr double kMega = 1e6, kMinute = 60;
  const double megabytes = kBaseMegabytes + voxels * kBytesPerVoxel / kMega;
  const double minutes = kBaseMinutes + voxels * kMicrosecondsPerVoxel / kMega / kMinute;
  return {static_cast<int>(std::ceil(megabytes)), static_cast<int>(std::ceil(minutes))};
}

SlurmRequest requestOf(const convert::BuildRow& row, const Progress& progress) {
  double voxels = 0;
  try {
    voxels = voxelsOf(row.input, progress);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled) throw;
    progress.check();
  }
  return requestFor(voxels);
}

}  // namespace lumen::engine
