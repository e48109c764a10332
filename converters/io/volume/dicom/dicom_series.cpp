// SPDX-License-Identifier: Apache-2.0
#include "converters/io/volume/dicom/dicom_series.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_pixels.h"
#include "converters/io/volume/dicom/dicom_stack.h"
#include "converters/io/volume/upright_grid.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

constexpr int kMostPixels = 128;  // along an edge of a picture
// Shares of the pixels that are black and white in a picture.
constexpr double kDarkShare = 0.02, kBrightShare = 0.995;

/// One pixel of every `step`, from the first on; black and white are chosen from these.
GreyPicture reduced(const Voxels& voxels, int columns, int rows) {
  const int step = std::max(1, (std::max(columns, rows) + kMostPixels - 1) / kMostPixels);
  GreyPicture picture{(columns + step - 1) / step, (rows + step - 1) / step, {}};
  std::vector<double> value;
  std::visit(
      [&](const auto& all) {
        for (int j = 0; j < rows; j += step)
          for (int i = 0; i < columns; i += step)
            value.push_back(static_cast<double>(
                all[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(i)]));
      },
      voxels);
  std::vector<double> sorted = value;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  const double dark = at(kDarkShare), span = std::max(at(kBrightShare) - dark, 1e-12);
  picture.pixel.reserve(value.size());
  for (const double v : value)
    picture.pixel.push_back(
        static_cast<std::uint8_t>(std::lround(255 * std::clamp((v - dark) / span, 0.0, 1.0))));
  return picture;
}

/// The middle frame of the middle file, by number of the file where no stack can be had.
GreyPicture pictureOf(const DicomImage& image, std::size_t frame, const Progress& progress) {
  try {
    return reduced(readDicomFrame(image, frame, progress), static_cast<int>(image.columns),
                   static_cast<int>(image.rows));
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled) throw;
    return {};  // the reader of the volume will report it
  }
}

DicomSeries describe(std::vector<DicomImage> images, const ReadVolumeOptions& options,
                     const InputFile& folder, const Progress& progress) {
  DicomSeries series;
  const DicomImage& first = images[0];
  series.uid = first.series;
  series.description = first.description;
  series.modality = first.modality;
  series.files = images.size();
  std::size_t frames = 0;
  for (const DicomImage& image : images) frames += image.frames;
  series.size = {static_cast<int>(first.columns), static_cast<int>(first.rows),
                 static_cast<int>(frames)};
  const DicomImage middle = images[images.size() / 2];
  try {
    const DicomStack stack = stackOf({std::move(images), {}}, options, folder.path());
    VolumeGeometry geometry = stack.geometry;
    (void)standUpright(geometry);
    checkGeometry(geometry, folder.path());
    series.spacing = geometry.spacing;
    const DicomFrame& frame = stack.slices[stack.slices.size() / 2];
    series.picture = pictureOf(*frame.image, frame.frame, progress);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::Cancelled) throw;
    series.fault = error.what();
    series.picture = pictureOf(middle, middle.frames / 2, progress);
  }
  return series;
}

}  // namespace

DicomListing listDicomSeries(const InputFile& folder, const ReadVolumeOptions& options,
                             Progress& progress) {
  progress.begin("looking for series", 0);
  DicomFolder found = scanDicomFolder(folder, progress);
  DicomListing listing;
  for (auto& [uid, images] : found.series)
    listing.series.push_back(describe(std::move(images), options, folder, progress));
  for (const DicomScan& scan : found.faulty) listing.faults.emplace_back(scan.fault->what());
  listing.others = found.others.size();
  progress.end();
  return listing;
}

}  // namespace lumen::convert
