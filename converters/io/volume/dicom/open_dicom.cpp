// SPDX-License-Identifier: Apache-2.0
// DICOM of open_volume.h.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "converters/io/volume/dicom/dicom_folder.h"
#include "converters/io/volume/dicom/dicom_pixels.h"
#include "converters/io/volume/dicom/dicom_stack.h"
#include "converters/io/volume/volume_format.h"

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

Voxels readSlices(const DicomStack& stack, const Progress& progress) {
  Voxels all;
  bool first = true;
  for (const DicomFrame& slice : stack.slices) {
    progress.check();
    Voxels voxels = readDicomFrame(*slice.image, slice.frame, progress);
    if (std::exchange(first, false))
      all = std::visit([](auto& v) -> Voxels { return std::decay_t<decltype(v)>(); }, voxels);
    append(all, std::move(voxels), stack.geometry.voxelCount());
  }
  return all;
}

/// The padding that an image states, in the units of the voxels.
std::optional<std::array<float, 2>> paddingOf(const DicomImage& image) {
  if (!image.padding) return std::nullopt;
  const DicomPlane& plane = image.perFrame.empty() ? image.plane : image.perFrame[0];
  const auto scale = [&](double stored) {
    return static_cast<float>(plane.slope.value_or(1) * stored + plane.intercept.value_or(0));
  };
  const float one = scale((*image.padding)[0]), other = scale((*image.padding)[1]);
  return std::array{std::min(one, other), std::max(one, other)};
}

OpenVolume openDicom(const InputFile& folder, const ReadVolumeOptions& options,
                     const Progress& progress) {
  const fs::path& path = folder.path();
  // shared, because slices point to its images
  const auto stack = std::make_shared<const DicomStack>(
      stackOf(findDicomSeries(folder, options, progress), options, path));
  const DicomImage& first = stack->images[0];
  OpenVolume open;
  open.padding = paddingOf(first);
  VolumeHeader& header = open.header;
  header.geometry = stack->geometry;
  header.storedType = (first.isSigned ? "int" : "uint") + std::to_string(first.bitsAllocated);
  header.encoding = encodingName(first.packing);
  header.voxelBytes = first.frameBytes() * stack->slices.size();
  for (const DicomImage& image : stack->images) header.storedBytes += image.file.size();
  header.assumptions = stack->assumptions;
  open.readVoxels = [stack](const Progress& running, std::vector<std::string>&) {
    return readSlices(*stack, running);
  };
  return open;
}

}  // namespace

constinit const VolumeFormat VolumeFormat::Dicom{openDicom, nullptr, true};

}  // namespace lumen::convert
