// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/image_file.h"

#include <limits>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

/// A header with settled geometry whose files can hold the voxels.
struct CheckedHeader {
  VolumeHeader shown;
  StoredVoxels voxels;
};

CheckedHeader checkedHeader(const fs::path& path, VolumeFormat format,
                            const ReadVolumeOptions& options, const Progress& progress) {
  progress.check();
  ImageHeader header =
      format == VolumeFormat::Nrrd ? readNrrdHeader(path, options) : readMetaHeader(path, options);
  CheckedHeader checked;
  VolumeHeader& shown = checked.shown;
  shown.assumptions = std::move(header.assumptions);
  shown.storedType = nameOf(header.voxels.type);
  shown.encoding = std::move(header.encoding);
  shown.voxelBytes = header.voxels.wantedCount() * sizeOf(header.voxels.type);
  shown.storedBytes = checkStored(header.voxels, shown.assumptions);
  shown.geometry = settledGeometry(header.stated, options, path, shown.assumptions);
  checked.voxels = std::move(header.voxels);
  return checked;
}

}  // namespace

std::array<int, 3> volumeSize(const fs::path& path, const std::vector<std::int64_t>& sizes) {
  const std::string text = joinedNumbers(sizes, " x ");
  double voxels = 1;
  for (const std::int64_t size : sizes) voxels *= static_cast<double>(size);
  if (sizes.size() < 3) refuseDimensions(path, static_cast<unsigned>(sizes.size()), text);
  // beyond any file, and far below overflow
  constexpr double kMostVoxels = 1e15;
  if (voxels > kMostVoxels)
    throw invalidInput(path.string() + ": its header announces " + longNumber(voxels) +
                       " voxels (" + text + "), more than any file can hold");
  return {static_cast<int>(sizes[0]), static_cast<int>(sizes[1]), static_cast<int>(sizes[2])};
}

void chooseVoxels(const fs::path& path, const std::vector<std::int64_t>& sizes,
                  const ReadVolumeOptions& options, StoredVoxels& voxels,
                  std::size_t voxelsOfVolume) {
  voxels.count = 1;
  for (const std::int64_t size : sizes) voxels.count *= static_cast<std::uint64_t>(size);
  voxels.first = voxelsOfVolume * chosenVolume(path, joinedNumbers(sizes, " x "),
                                               voxels.count / voxelsOfVolume, options.volumeIndex);
  voxels.wanted = voxelsOfVolume;
}

Volume readImageFile(const fs::path& path, VolumeFormat format, const ReadVolumeOptions& options,
                     const Progress& progress) {
  CheckedHeader header = checkedHeader(path, format, options, progress);
  Volume volume;
  volume.geometry = header.shown.geometry;
  volume.assumptions = std::move(header.shown.assumptions);
  volume.voxels = readStored(header.voxels, progress, volume.assumptions);
  return volume;
}

VolumeHeader readImageFileHeader(const fs::path& path, VolumeFormat format,
                                 const ReadVolumeOptions& options, const Progress& progress) {
  return checkedHeader(path, format, options, progress).shown;
}

}  // namespace lumen::convert
