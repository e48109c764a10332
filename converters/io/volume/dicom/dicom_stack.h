// SPDX-License-Identifier: Apache-2.0
// The slices of a DICOM series as a regular stack.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "converters/io/volume/dicom/dicom_folder.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

/// One frame of one file.
struct DicomFrame {
  const DicomImage* image = nullptr;
  std::size_t frame = 0;
  DicomPlane plane;
  double position = 0;   ///< mm along the slices' normal
  std::size_t slot = 0;  ///< slice of the volume that a frame of a segmentation is in
  [[nodiscard]] std::string name() const {
    const std::string file = image->file.path().filename().string();
    return image->frames == 1 ? file : file + " (frame " + std::to_string(frame + 1) + ")";
  }
};

/// A series, complete except for its pixels.
struct DicomStack {
  std::vector<DicomImage> images;
  std::vector<DicomFrame> slices;  ///< in the volume's order
  VolumeGeometry geometry;         ///< its third axis leans under a gantry tilt
  std::vector<double> places;      ///< as SliceSpacing::places
  std::string filled;              ///< a sentence on slices that are interpolated
  bool isLabelled = false;         ///< a segmentation: frames may be missing, and share a slice
  std::vector<std::string> assumptions;
  /// Slices of the volume.
  [[nodiscard]] std::size_t count() const { return places.empty() ? slices.size() : places.size(); }
};

/// The stack of these images of one series. Throws Error(InvalidInput) for images that form no
/// regular stack, upright or leaning. Frames of a segmentation form one if their distances are
/// multiples of the one that they state, or of the least; `path`, their folder, is in messages.
DicomStack stackOf(DicomChoice choice, const ReadVolumeOptions& options,
                   const std::filesystem::path& path);

}  // namespace lumen::convert
