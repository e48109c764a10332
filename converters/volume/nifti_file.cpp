// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/nifti_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nifti/nifti1_io.h>
#include <zlib.h>

#include "converters/common/error.h"
#include "converters/volume/nifti_geometry.h"
#include "converters/volume/nifti_header.h"
#include "converters/volume/stated_geometry.h"
#include "converters/volume/volume_checks.h"
#include "converters/volume/voxel_stream.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = 16 << 20;
static_assert(sizeof(nifti_1_header) == kNiftiHeaderSize);

using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

/// A file whose header has been accepted.
struct OpenNifti {
  NiftiHeader header;
  bool packed = false;
  std::size_t fileSize = 0;
  VolumeGeometry geometry;
  std::vector<std::string> assumptions;
  VoxelStream stream;  ///< at the first voxel
};

/// Walks the extensions, whose sizes are in the file, up to the first voxel.
void skipExtensions(VoxelStream& stream, const NiftiHeader& header) {
  std::array<std::byte, 4> announced{};
  const std::size_t got = stream.read(announced);
  std::size_t at = kNiftiHeaderSize + got;
  const bool hasExtensions = announced[0] != std::byte{0};
  constexpr std::size_t kSizeAndCode = 8;
  while (hasExtensions && at + kSizeAndCode <= header.voxelOffset) {
    std::array<std::byte, 4> raw{};
    if (stream.read(raw) != raw.size()) break;
    if (header.swapped) std::reverse(raw.begin(), raw.end());
    const auto size = std::bit_cast<std::int32_t>(raw);
    if (size < static_cast<int>(kSizeAndCode) ||
        static_cast<std::size_t>(size) > header.voxelOffset - at)
      throw invalidInput(stream.path().string() + ": its header extension at byte " +
                         std::to_string(at) + " has " + std::to_string(size) +
                         " bytes; expected 8 to " + std::to_string(header.voxelOffset - at) +
                         ", up to the voxels at byte " + std::to_string(header.voxelOffset) +
                         " (vox_offset)");
    at += static_cast<std::size_t>(size);
    if (stream.skip(static_cast<std::size_t>(size) - raw.size()) != size - raw.size()) break;
  }
  if (at < header.voxelOffset) stream.skip(header.voxelOffset - at);
}

/// Spacings that --spacing does not replace must be some.
void checkSpacings(const NiftiHeader& header, const fs::path& path) {
  for (std::size_t a = 0; a < 3; ++a)
    if (!(std::isfinite(header.pixdim[a]) && header.pixdim[a] > 0))
      throw invalidInput(path.string() + ": pixdim states a spacing of " +
                         numberText(static_cast<double>(header.pixdim[a])) + " along axis " +
                         std::to_string(a + 1) +
                         "; expected a positive number; state the spacing with --spacing");
}

void checkFileHolds(const OpenNifti& file) {
  const double before = file.packed ? 0 : static_cast<double>(file.header.voxelOffset);
  checkRoom(file.stream.path(), static_cast<double>(file.header.voxelBytes()),
            static_cast<double>(file.fileSize) - before, file.packed);
}

/// A slice or more behind the last voxel: the header may say less than the file holds.
void tellRest(OpenNifti& file, std::size_t rest, bool more) {
  const std::size_t slice =
      file.header.voxelBytes() / static_cast<std::size_t>(file.header.size[2]);
  if (rest < slice) return;
  file.assumptions.push_back(
      (more ? "at least " : "") + std::to_string(rest) +
      " bytes follow the voxels that its header announces, and are left out");
}

void settleGeometry(OpenNifti& file, const ReadVolumeOptions& options) {
  const fs::path& path = file.stream.path();
  if (!options.spacing) checkSpacings(file.header, path);
  const StatedGeometry stated = niftiGeometry(file.header, options, path, file.assumptions);
  const std::size_t before = file.assumptions.size();
  file.geometry = settledGeometry(stated, options, path, file.assumptions);
  const bool told = file.assumptions.size() > before;  // that the unit is not known, and odd
  if (!told && !stated.unit && !options.unit && !options.spacing)
    file.assumptions.push_back(
        "its header states no unit of length that NIfTI has (xyzt_units is " +
        std::to_string(file.header.unitCode) +
        "), so lengths are taken as mm; state the unit with --unit");
}

OpenNifti openNifti(const fs::path& path, const ReadVolumeOptions& options,
                    const Progress& progress) {
  const bool packed = isGzip(path);
  VoxelStream stream(path, 0, packed ? Packing::Deflate : Packing::None, progress);
  std::array<std::byte, kNiftiHeaderSize> bytes{};
  const std::size_t got = stream.read(bytes);
  if (got != bytes.size())
    throw invalidInput(path.string() + ": truncated: " + std::to_string(got) +
                       " bytes can be read, but a NIfTI header has 348");
  OpenNifti file{.header = parseNiftiHeader(bytes, path),
                 .packed = packed,
                 .fileSize = fs::file_size(path),
                 .geometry = {},
                 .assumptions = {},
                 .stream = std::move(stream)};
  checkFileHolds(file);
  settleGeometry(file, options);
  skipExtensions(file.stream, file.header);
  return file;
}

template <class To, class From, class Function>
std::vector<To> converted(const std::vector<From>& raw, Function function) {
  std::vector<To> out(raw.size());
  std::transform(raw.begin(), raw.end(), out.begin(),
                 [&](From v) { return static_cast<To>(function(v)); });
  return out;
}

template <class From, class To>
Voxels readAs(OpenNifti& file) {
  const NiftiHeader& header = file.header;
  std::vector<From> raw = readValues<From>(file.stream, header.voxelCount());
  if (header.swapped && sizeof(From) > 1)
    nifti_swap_Nbytes(raw.size(), static_cast<int>(sizeof(From)), raw.data());
  if (header.isScaled()) {
    const auto slope = static_cast<double>(header.slope);
    const auto intercept = static_cast<double>(header.intercept);
    return converted<float>(raw,
                            [=](From v) { return slope * static_cast<double>(v) + intercept; });
  }
  if constexpr (std::is_same_v<From, To>)
    return raw;
  else
    return converted<To>(raw, [](From v) { return v; });
}

Voxels readTyped(OpenNifti& file) {
  switch (file.header.type.code) {
    case DT_UINT8:
      return readAs<std::uint8_t, std::uint8_t>(file);
    case DT_INT16:
      return readAs<std::int16_t, std::int16_t>(file);
    case DT_INT32:
      return readAs<std::int32_t, float>(file);
    case DT_FLOAT32:
      return readAs<float, float>(file);
    case DT_FLOAT64:
      return readAs<double, float>(file);
    case DT_INT8:
      return readAs<std::int8_t, std::int16_t>(file);
    case DT_UINT16:
      return readAs<std::uint16_t, std::uint16_t>(file);
    case DT_UINT32:
      return readAs<std::uint32_t, float>(file);
    case DT_INT64:
      return readAs<std::int64_t, float>(file);
    default:
      return readAs<std::uint64_t, float>(file);
  }
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
  volume.voxels = readTyped(file);
  // also brings the checksum of a gzip stream, which follows its last byte
  const std::size_t most = file.header.voxelBytes() + 1;
  const std::size_t rest = file.stream.skip(most);
  tellRest(file, rest, rest == most);
  volume.assumptions = std::move(file.assumptions);
  return volume;
}

VolumeHeader readNiftiHeader(const fs::path& path, const ReadVolumeOptions& options,
                             const Progress& progress) {
  OpenNifti file = openNifti(path, options, progress);
  if (!file.packed)
    tellRest(file, file.fileSize - file.header.voxelOffset - file.header.voxelBytes(), false);
  return {.geometry = file.geometry,
          .storedType = file.header.type.name,
          .encoding = file.packed ? "gzip" : "raw",
          .voxelBytes = file.header.voxelBytes(),
          .storedBytes = file.fileSize,
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
