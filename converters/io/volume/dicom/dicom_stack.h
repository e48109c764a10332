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
  double position = 0;  ///< mm along the slices' normal
  [[nodiscard]] std::string name() const {
    const std::string file = image->file.path().filename().string();
    return image->frames == 1 ? file : file + " (frame " + std::to_string(frame + 1) + ")";
  }
};

/// A series, complete except for its pixels.
struct DicomStack {
  std::vector<DicomImage> images;
  std::vector<DicomFrame> slices;  ///< in the volume's order
  VolumeGeometry geometry;
  std::vector<std::string> assumptions;
};

/// The stack of these images of one series. Throws Error(InvalidInput) for images that form no
/// regular stack; `path`, their folder, is in messages.
DicomStack stackOf(DicomChoice choice, const ReadVolumeOptions& options,
                   const std::filesystem::path& path);

}  // namespace lumen::convert
