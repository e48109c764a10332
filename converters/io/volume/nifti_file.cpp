// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/nifti_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nifti/nifti1_io.h>
#include <zlib.h>

#include "converters/base/error.h"
#include "converters/base/option_name.h"
#include "converters/io/volume/nifti_geometry.h"
#include "converters/io/volume/nifti_header.h"
#include "converters/io/volume/packed_file.h"
#include "converters/io/volume/stated_geometry.h"
#include "converters/io/volume/stored_voxels.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = 16 << 20;
static_assert(sizeof(nifti_1_header) == kNiftiHeaderSize);

using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

/// A file with an accepted header.
struct OpenNifti {
  NiftiHeader header;
  VolumeGeometry geometry;
  StoredVoxels voxels;
  std::uint64_t storedBytes = 0;
  std::string placedBy;
  std::vector<std::string> assumptions;
};

bool isGzip(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw invalidInput(path.string() + ": cannot be opened");
  std::array<char, 2> magic{};
  file.read(magic.data(), magic.size());
  return file && magic[0] == '\x1f' && magic[1] == '\x8b';
}

/// Walks the extensions, whose sizes are in the file, up to the first voxel; `file` is behind the
/// header.
void checkExtensions(PackedFile& file, const NiftiHeader& header, const fs::path& path) {
  std::array<std::byte, 4> announced{}, raw{};
  if (file.read(announced.data(), 4) < 4 || announced[0] == std::byte{0}) return;
  constexpr std::size_t kSizeAndCode = 8;
  for (std::size_t at = kNiftiFirstVoxel; at + kSizeAndCode <= header.voxelOffset;) {
    if (file.read(raw.data(), raw.size()) < raw.size()) return;
    if (header.swapped) std::reverse(raw.begin(), raw.end());
    const auto size = std::bit_cast<std::int32_t>(raw);
    const std::size_t room = header.voxelOffset - at;
    if (size < static_cast<int>(kSizeAndCode) || static_cast<std::size_t>(size) > room)
      throw invalidInput(path.string() + ": its header extension at byte " + std::to_string(at) +
                         " has " + std::to_string(size) + " bytes; expected 8 to " +
                         std::to_string(room) + ", up to the voxels at byte " +
                         std::to_string(header.voxelOffset) + " (vox_offset)");
    std::vector<std::byte> rest(static_cast<std::size_t>(size) - raw.size());
    if (file.read(rest.data(), rest.size()) < rest.size()) return;
    at += static_cast<std::size_t>(size);
  }
}

/// Spacings that --spacing does not override must be valid.
void checkSpacings(const NiftiHeader& header, const fs::path& path) {
  for (std::size_t a = 0; a < 3; ++a)
    if (!(std::isfinite(header.pixdim[a]) && header.pixdim[a] > 0))
      throw invalidInput(path.string() + ": pixdim states a spacing of " +
                         longNumber(static_cast<double>(header.pixdim[a])) + " along axis " +
                         std::to_string(a + 1) +
                         "; expected a positive number; state the spacing with " +
                         kOption.spacing.shown());
}

void settleGeometry(OpenNifti& file, const fs::path& path, const ReadVolumeOptions& options) {
  if (!options.spacing) checkSpacings(file.header, path);
  const StatedGeometry stated = niftiGeometry(file.header, options, path, file.assumptions);
  file.placedBy = stated.placedBy;
  const std::size_t before = file.assumptions.size();
  file.geometry = settledGeometry(stated, options, path, file.assumptions);
  const bool isReported = file.assumptions.size() > before;  // the unknown unit is reported
  if (!isReported && !stated.unit && !options.unit && !options.spacing)
    file.assumptions.push_back(
        "its header states no unit of length that NIfTI has (xyzt_units is " +
        std::to_string(file.header.unitCode) +
        "), so lengths are taken as mm; state the unit with " + kOption.unit.shown());
}

StoredVoxels storedVoxels(const fs::path& path, const NiftiHeader& header, Packing packing,
                          const ReadVolumeOptions& options) {
  StoredVoxels stored;
  stored.header = path;
  stored.files = {path};
  stored.wanted = header.voxelCount();
  stored.count = header.volumes * header.voxelCount();
  stored.first =
      header.voxelCount() * chosenVolume(path, header.sizes, header.volumes, options.volumeIndex);
  stored.type = header.type;
  stored.bigEndian = header.swapped;
  stored.packing = packing;
  if (packing == Packing::Raw)
    stored.offset = header.voxelOffset;
  else
    stored.byteSkip = static_cast<std::int64_t>(header.voxelOffset);
  if (header.isScaled()) {
    const auto slope = static_cast<double>(header.slope);
    stored.scaling = {slope, static_cast<double>(header.intercept)};
  }
  return stored;
}

OpenNifti openNifti(const fs::path& path, const ReadVolumeOptions& options,
                    const Progress& progress) {
  StoredVoxels whole;
  whole.packing = isGzip(path) ? Packing::Deflate : Packing::Raw;
  const auto bytes = openPacked(whole, path, 0, progress);
  std::array<std::byte, kNiftiHeaderSize> head{};
  const std::size_t got = bytes->read(head.data(), head.size());
  if (got >= sizeof(std::int32_t)) checkNiftiStart(head, path);
  if (got != head.size())
    throw invalidInput(path.string() + ": truncated: " + std::to_string(got) +
                       " bytes can be read, but a NIfTI header has 348");
  OpenNifti file;
  file.header = parseNiftiHeader(head, path);
  file.voxels = storedVoxels(path, file.header, whole.packing, options);
  file.storedBytes = checkStored(file.voxels, file.assumptions);
  settleGeometry(file, path, options);
  checkExtensions(*bytes, file.header, path);
  return file;
}

short datatypeOf(const Voxels& voxels) {
  constexpr std::array<short, 4> kTypes = {DT_UINT8, DT_INT16, DT_UINT16, DT_FLOAT32};
  return kTypes[voxels.index()];
}

void writeBytes(gzFile file, const void* bytes, std::size_t size, const fs::path& path) {
  const auto* from = static_cast<const char*>(bytes);
  for (std::size_t done = 0; done < size;) {
    const auto count = static_cast<unsigned>(std::min(kChunk, size - done));
    if (gzwrite(file, from + done, count) != static_cast<int>(count))
      throw failed(path.string() + ": cannot be written");
    done += count;
  }
}

}  // namespace

Volume readNifti(const fs::path& path, const ReadVolumeOptions& options, const Progress& progress) {
  OpenNifti file = openNifti(path, options, progress);
  Volume volume;
  volume.geometry = file.geometry;
  volume.voxels = readStored(file.voxels, progress, file.assumptions);
  volume.assumptions = std::move(file.assumptions);
  return volume;
}

VolumeHeader readNiftiHeader(const fs::path& path, const ReadVolumeOptions& options,
                             const Progress& progress) {
  OpenNifti file = openNifti(path, options, progress);
  return {.geometry = file.geometry,
          .storedType = nameOf(file.header.type),
          .encoding = file.voxels.packing == Packing::Deflate ? "gzip" : "raw",
          .voxelBytes = file.header.voxelBytes(),
          .storedBytes = file.storedBytes,
          .placedBy = file.placedBy,
          .assumptions = std::move(file.assumptions)};
}

void writeNifti(const Volume& volume, const fs::path& file, bool compressed, const fs::path& name) {
  const nifti_1_header header = niftiHeader(volume.geometry, datatypeOf(volume.voxels), name);
  GzFile stream(gzopen(file.c_str(), compressed ? "wb" : "wbT"), gzclose);
  if (!stream) throw failed(name.string() + ": cannot be written");
  constexpr std::array<char, 4> kNoExtensions{};
  writeBytes(stream.get(), &header, sizeof(header), name);
  writeBytes(stream.get(), kNoExtensions.data(), kNoExtensions.size(), name);
  std::visit(
      [&](const auto& voxels) {
        writeBytes(stream.get(), voxels.data(), voxels.size() * sizeof(voxels[0]), name);
      },
      volume.voxels);
  if (gzclose(stream.release()) != Z_OK) throw failed(name.string() + ": cannot be written");
}

}  // namespace lumen::convert
