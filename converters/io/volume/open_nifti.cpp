// SPDX-License-Identifier: Apache-2.0
// NIfTI-1 of open_volume.h.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/nifti_header.h"
#include "converters/io/volume/packed_file.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

bool isGzip(const InputFile& file) {
  const std::unique_ptr<std::istream> stream = file.open();
  std::array<char, 2> magic{};
  stream->read(magic.data(), magic.size());
  return *stream && magic[0] == '\x1f' && magic[1] == '\x8b';
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

/// Spacings that the options do not override must be valid.
void checkSpacings(const NiftiHeader& header, const FieldWord& word, const fs::path& path) {
  for (std::size_t a = 0; a < 3; ++a)
    if (!(std::isfinite(header.pixdim[a]) && header.pixdim[a] > 0))
      throw invalidInput(path.string() + ": pixdim states a spacing of " +
                         longNumber(static_cast<double>(header.pixdim[a])) + " along axis " +
                         std::to_string(a + 1) +
                         "; expected a positive number; state the spacing with " + word("spacing"));
}

StoredVoxels storedVoxels(const InputFile& file, const NiftiHeader& header, Packing packing,
                          const ReadVolumeOptions& options) {
  StoredVoxels stored;
  const fs::path& path = file.path();
  stored.header = path;
  stored.files = {file};
  stored.wanted = header.voxelCount();
  stored.count = header.volumes * header.voxelCount();
  stored.first = header.voxelCount() * chosenVolume(path, header.sizes, header.volumes, options);
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

OpenVolume openNifti(const InputFile& file, const ReadVolumeOptions& options,
                     const Progress& progress) {
  const fs::path& path = file.path();
  StoredVoxels whole;
  whole.packing = isGzip(file) ? Packing::Deflate : Packing::Raw;
  const auto bytes = openPacked(whole, file, 0, progress);
  std::array<std::byte, kNiftiHeaderSize> head{};
  const std::size_t got = bytes->read(head.data(), head.size());
  if (got >= sizeof(std::int32_t)) checkNiftiStart(head, path);
  if (got != head.size())
    throw invalidInput(path.string() + ": truncated: " + std::to_string(got) +
                       " bytes can be read, but a NIfTI header has 348");
  const NiftiHeader header = parseNiftiHeader(head, path);
  if (!options.spacing) checkSpacings(header, options.word, path);
  ImageHeader image;
  image.voxels = storedVoxels(file, header, whole.packing, options);
  image.encoding = whole.packing == Packing::Deflate ? "gzip" : "raw";
  if (header.isSlopeMissing)
    image.assumptions.emplace_back(
        "its scl_slope is not a number (NaN), so its values are taken as they are stored");
  image.stated = niftiGeometry(header, options, path, image.assumptions);
  OpenVolume open = openImage(std::move(image), options, path);
  checkExtensions(*bytes, header, path);
  return open;
}

}  // namespace

std::string niftiExtensions(const InputFile& file) {
  constexpr std::size_t kMost = 1 << 20;
  try {
    StoredVoxels whole;
    whole.packing = isGzip(file) ? Packing::Deflate : Packing::Raw;
    const auto bytes = openPacked(whole, file, 0, Progress());
    std::array<std::byte, kNiftiHeaderSize> head{};
    if (bytes->read(head.data(), head.size()) < head.size()) return {};
    const NiftiHeader header = parseNiftiHeader(head, file.path());
    std::string text(std::min(header.voxelOffset - kNiftiHeaderSize, kMost), '\0');
    text.resize(bytes->read(std::as_writable_bytes(std::span(text)).data(), text.size()));
    return text;
  } catch (const Error&) {
    return {};  // the reader of voxels states the fault
  }
}

constinit const VolumeFormat VolumeFormat::Nifti{openNifti, encodeAsNifti};

}  // namespace lumen::convert
