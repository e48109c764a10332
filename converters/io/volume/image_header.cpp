// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/image_header.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

// Bounds, mm, beyond which a spacing is no distance between voxels of a body, whatever its unit.
constexpr double kLeastSpacing = 1e-6, kMostSpacing = 1e4;
// Bounds, mm, beyond which a spacing is likely to be in another unit: 5 um is a fine micro-CT, 50
// mm no scan.
constexpr double kLeastUsual = 5e-3, kMostUsual = 50;

Eigen::Vector3d settledSpacing(const Eigen::Vector3d& stated, double unit, const FieldWord& word,
                               const fs::path& path, std::vector<std::string>& assumptions) {
  const auto missing = stated.array().isNaN();
  if (missing.all()) {
    assumptions.emplace_back(
        "its header states no spacing, so voxels are taken to be 1 mm apart; state it with " +
        word("spacing"));
    return Eigen::Vector3d::Ones();
  }
  for (int a = 0; a < 3; ++a)
    if (missing[a])
      throw invalidInput(path.string() + ": its header states no spacing along axis " +
                         std::to_string(a + 1) + ", but along others; state all three with " +
                         word("spacing"));
  return unit * stated;
}

void checkSpacing(const Eigen::Vector3d& spacing, const FieldWord& word, const fs::path& path) {
  for (int a = 0; a < 3; ++a)
    if (!(spacing[a] >= kLeastSpacing && spacing[a] <= kMostSpacing))
      throw invalidInput(path.string() + ": the spacing along axis " + std::to_string(a + 1) +
                         " is " + longNumber(spacing[a]) + " mm; expected " +
                         longNumber(kLeastSpacing) + " to " + longNumber(kMostSpacing) +
                         "; state it with " + word("spacing") + ", or the file's unit with " +
                         word("unit"));
}

}  // namespace

VolumeGeometry settledGeometry(const StatedGeometry& stated, const ReadVolumeOptions& options,
                               const fs::path& path, std::vector<std::string>& assumptions) {
  VolumeGeometry geometry = stated.geometry;
  const double unit = options.unit.value_or(stated.unit.value_or(1));
  geometry.origin *= unit;
  geometry.spacing = options.spacing ? *options.spacing
                                     : settledSpacing(stated.geometry.spacing, unit, options.word,
                                                      path, assumptions);
  checkSpacing(geometry.spacing, options.word, path);
  const bool unusual =
      geometry.spacing.minCoeff() < kLeastUsual || geometry.spacing.maxCoeff() > kMostUsual;
  if (unusual && !options.spacing && !options.unit)
    assumptions.push_back((stated.unit ? "by the unit that its header states, its spacing is "
                                       : "its header states no unit, so its spacing is taken as ") +
                          spacingText(geometry.spacing, kHeaderDigits) +
                          " mm, which is unusual; state the unit with " + options.word("unit"));
  else if (!stated.unit && !options.unit && !options.spacing && !stated.unitNote.empty())
    assumptions.push_back(stated.unitNote);
  return geometry;
}

void cropGeometry(VolumeGeometry& geometry, const CellBox& box, const fs::path& path) {
  const Cell first = box.low, last = box.high(), end = geometry.cells().high();
  for (int a = 0; a < 3; ++a)
    if (first[a] < 0 || last[a] > end[a] || last[a] <= first[a])
      throw invalidInput(path.string() + ": the crop box goes from " + std::to_string(first[a]) +
                         " to " + std::to_string(last[a]) + " along axis " + std::to_string(a + 1) +
                         "; expected at least two voxels within 0 to " + std::to_string(end[a]));
  geometry.origin = geometry.position(first);
  geometry.size = {box.size[0], box.size[1], box.size[2]};
}

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
                                               voxels.count / voxelsOfVolume, options);
  voxels.wanted = voxelsOfVolume;
}

}  // namespace lumen::convert
