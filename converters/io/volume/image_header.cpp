// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/image_header.h"

#include <limits>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {

namespace fs = std::filesystem;

OpenVolume openImage(ImageHeader image, const ReadVolumeOptions& options, const fs::path& path) {
  OpenVolume open;
  VolumeHeader& header = open.header;
  header.assumptions = std::move(image.assumptions);
  header.storedType = nameOf(image.voxels.type);
  header.encoding = std::move(image.encoding);
  header.voxelBytes = image.voxels.wantedCount() * sizeOf(image.voxels.type);
  header.storedBytes = checkStored(image.voxels, header.assumptions);
  header.geometry = settledGeometry(image.stated, options, path, header.assumptions);
  header.placedBy = std::move(image.stated.placedBy);
  open.readVoxels = [voxels = std::move(image.voxels)](const Progress& progress,
                                                       std::vector<std::string>& assumptions) {
    return readStored(voxels, progress, assumptions);
  };
  return open;
}

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

}  // namespace lumen::convert
