// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/read_dicom.h"

#include <type_traits>
#include <utility>
#include <vector>

#include "converters/io/volume/dicom_folder.h"
#include "converters/io/volume/dicom_pixels.h"
#include "converters/io/volume/dicom_stack.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

std::vector<float> asFloats(const Voxels& voxels) {
  return std::visit([](const auto& v) { return std::vector<float>(v.begin(), v.end()); }, voxels);
}

/// Slices may differ in type, where each has its own rescale slope; then all become float.
void append(Voxels& all, Voxels slice, std::size_t count) {
  if (all.index() != slice.index()) {
    all = asFloats(all);
    slice = asFloats(slice);
  }
  std::visit(
      [&](auto& to) {
        to.reserve(count);
        const auto& from = std::get<std::decay_t<decltype(to)>>(slice);
        to.insert(to.end(), from.begin(), from.end());
      },
      all);
}

std::string encodingName(DicomPacking packing) {
  switch (packing) {
    case DicomPacking::Jpeg:
      return "JPEG";
    case DicomPacking::JpegLs:
      return "JPEG-LS";
    case DicomPacking::Jpeg2000:
      return "JPEG 2000";
    case DicomPacking::RunLength:
      return "RLE";
    default:
      return "raw";
  }
}

}  // namespace

Volume readDicom(const fs::path& path, const ReadVolumeOptions& options, const Progress& progress) {
  DicomStack stack = stackOf(findDicomSeries(path, options, progress), options, path);
  Volume volume;
  volume.geometry = stack.geometry;
  volume.assumptions = std::move(stack.assumptions);
  bool first = true;
  for (const DicomFrame& slice : stack.slices) {
    progress.check();
    Voxels voxels = readDicomFrame(*slice.image, slice.frame, progress);
    if (std::exchange(first, false))
      volume.voxels =
          std::visit([](auto& v) -> Voxels { return std::decay_t<decltype(v)>(); }, voxels);
    append(volume.voxels, std::move(voxels), volume.geometry.voxelCount());
  }
  return volume;
}

VolumeHeader readDicomHeader(const fs::path& path, const ReadVolumeOptions& options,
                             const Progress& progress) {
  DicomStack stack = stackOf(findDicomSeries(path, options, progress), options, path);
  const DicomImage& first = stack.images[0];
  VolumeHeader header;
  header.geometry = stack.geometry;
  header.storedType = (first.isSigned ? "int" : "uint") + std::to_string(first.bitsAllocated);
  header.encoding = encodingName(first.packing);
  header.voxelBytes = first.frameBytes() * stack.slices.size();
  for (const DicomImage& image : stack.images) header.storedBytes += fs::file_size(image.file);
  header.assumptions = std::move(stack.assumptions);
  return header;
}

}  // namespace lumen::convert
