// SPDX-License-Identifier: Apache-2.0
// DICOM of open_volume.h.
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_folder.h"
#include "converters/io/volume/dicom/dicom_pixels.h"
#include "converters/io/volume/dicom/dicom_stack.h"
#include "converters/io/volume/dicom/painted_labels.h"
#include "converters/io/volume/dicom/slice_spacing.h"
#include "converters/io/volume/dicom/structure_set.h"
#include "converters/io/volume/volume_format.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Range = std::array<float, 2>;

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

/// The padding that a slice states, in the units of its voxels.
std::optional<Range> paddingOf(const DicomFrame& slice) {
  if (!slice.image->padding) return std::nullopt;
  const auto scale = [&](double stored) {
    return static_cast<float>(slice.plane.slope.value_or(1) * stored +
                              slice.plane.intercept.value_or(0));
  };
  const float one = scale((*slice.image->padding)[0]), other = scale((*slice.image->padding)[1]);
  return Range{std::min(one, other), std::max(one, other)};
}

/// The padding of a volume, to which those of all slices are set: that of the first slice with one.
std::optional<Range> paddingOf(const DicomStack& stack) {
  for (const DicomFrame& slice : stack.slices)
    if (const auto padding = paddingOf(slice)) return padding;
  return std::nullopt;
}

/// Sets what is padding in a slice, as its own rescaling has it, to that of the volume.
void unifyPadding(const DicomFrame& slice, const std::optional<Range>& whole, Voxels& voxels) {
  const auto own = paddingOf(slice);
  if (!own || own == whole) return;
  std::vector<float> values = asFloats(voxels);
  for (float& value : values)
    if (value >= (*own)[0] && value <= (*own)[1]) value = (*whole)[0];
  voxels = std::move(values);
}

Voxels readSlices(const DicomStack& stack, const Progress& progress) {
  const std::optional<Range> padding = paddingOf(stack);
  Voxels all;
  bool first = true;
  for (const DicomFrame& slice : stack.slices) {
    progress.check();
    Voxels voxels = readDicomFrame(*slice.image, slice.frame, progress);
    unifyPadding(slice, padding, voxels);
    if (std::exchange(first, false))
      all = std::visit([](auto& v) -> Voxels { return std::decay_t<decltype(v)>(); }, voxels);
    append(all, std::move(voxels), stack.geometry.voxelCount());
  }
  if (stack.places.empty()) return all;
  return slicesAt(stack.places, all, stack.images[0].columns * stack.images[0].rows, padding);
}

/// Calls use(voxel, value) for the voxels of a frame that are not 0.
template <class Use>
void eachMarked(const DicomFrame& frame, const Progress& progress, const Use& use) {
  const Voxels pixels = readDicomFrame(*frame.image, frame.frame, progress);
  const std::size_t first = frame.slot * frame.image->columns * frame.image->rows;
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < values.size(); ++i)
          if (const auto value = static_cast<double>(values[i]); value > 0) use(first + i, value);
      },
      pixels);
}

/// Labels of a segmentation whose pixels are labels.
Voxels readLabelMap(const DicomStack& stack, const Progress& progress) {
  std::vector<std::uint16_t> labels(stack.geometry.voxelCount(), 0);
  for (const DicomFrame& frame : stack.slices) {
    const std::optional<Range> around = paddingOf(frame);
    eachMarked(frame, progress, [&](std::size_t voxel, double value) {
      if (!around || value < static_cast<double>((*around)[0]) ||
          value > static_cast<double>((*around)[1]))
        labels[voxel] = static_cast<std::uint16_t>(std::min(value, 65535.0));
    });
  }
  return narrowLabels(std::move(labels));
}

/// Labels of a segmentation with frames for each segment. A share of half or more is the segment.
Voxels readSegments(const DicomStack& stack, const Progress& progress,
                    std::vector<std::string>& assumptions) {
  const DicomImage& image = stack.images[0];
  const bool isShare = image.labels == DicomLabels::Fractional;
  const double least = isShare ? 0.5 * static_cast<double>(image.mostFraction) : 0.5;
  if (isShare)
    assumptions.emplace_back(
        "its segments are shares (FRACTIONAL); voxels of a half and more are the segment");
  std::map<std::size_t, std::vector<const DicomFrame*>> frames;
  for (const DicomFrame& frame : stack.slices)
    frames[frame.image->segmentOf(frame.frame)].push_back(&frame);
  std::vector<PaintedStructure> structures;
  for (const auto& [segment, own] : frames) {
    if (segment == 0)
      throw invalidInput(image.file.path().string() +
                         ": a frame names no segment (0062,000b); expected its number, from 1");
    structures.push_back({segment, [&, &of = own](const std::function<void(std::size_t)>& mark) {
                            for (const DicomFrame* const frame : of) {
                              progress.check();
                              eachMarked(*frame, progress, [&](std::size_t voxel, double value) {
                                if (value >= least) mark(voxel);
                              });
                            }
                          }});
  }
  return paintedLabels(stack.geometry.voxelCount(), structures, assumptions);
}

bool isStructureSet(const InputFile& input) {
  return !input.isFolder() && scanDicom(input).storage == kDicomStructures;
}

OpenVolume openDicom(const InputFile& input, const ReadVolumeOptions& options,
                     const Progress& progress) {
  if (isStructureSet(input)) return openStructures(input, options, progress);
  const fs::path& path = input.path();
  // shared, because slices point to its images
  const auto stack = std::make_shared<const DicomStack>(
      stackOf(findDicomSeries(input, options, progress), options, path));
  const DicomImage& first = stack->images[0];
  OpenVolume open;
  if (!stack->isLabelled) open.padding = paddingOf(*stack);
  VolumeHeader& header = open.header;
  header.geometry = stack->geometry;
  header.storedType = (first.isSigned ? "int" : "uint") +
                      std::to_string(std::max<std::size_t>(first.bitsAllocated, 8));
  header.encoding = encodingName(first.packing);
  for (const DicomFrame& slice : stack->slices) header.voxelBytes += slice.image->frameBytes();
  for (const DicomImage& image : stack->images) header.storedBytes += image.file.size();
  header.assumptions = stack->assumptions;
  header.resampled = stack->filled;
  open.readVoxels = [stack](const Progress& running, std::vector<std::string>& assumptions) {
    if (!stack->isLabelled) return readSlices(*stack, running);
    return stack->images[0].labels == DicomLabels::Map ? readLabelMap(*stack, running)
                                                       : readSegments(*stack, running, assumptions);
  };
  return open;
}

}  // namespace

constinit const VolumeFormat VolumeFormat::Dicom{openDicom, nullptr, true};

}  // namespace lumen::convert
