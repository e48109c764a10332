// SPDX-License-Identifier: Apache-2.0
// Description of the image in a DICOM file, read strictly by lumen's own code, without a library.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "converters/base/error.h"
#include "converters/io/volume/dicom/dicom_elements.h"

namespace lumen::convert {

/// Packing of pixels.
enum class DicomPacking { Native, NativeBigEndian, Jpeg, JpegLs, Jpeg2000, RunLength };

/// Placement of an image or a frame, and the meaning of its stored values. Lengths are mm, vectors
/// LPS.
struct DicomPlane {
  std::optional<Eigen::Vector3d> position;           ///< centre of the first pixel
  std::optional<std::array<double, 6>> orientation;  ///< rows' direction, then columns'
  std::optional<std::array<double, 2>>
      pixelSpacing;                        ///< distance between rows, then between columns
  std::optional<double> distance;          ///< distance between slices or frames
  std::optional<double> slope, intercept;  ///< finite; the slope is not 0
};

/// An element that may tell volumes of one place in one series apart.
struct DicomPhaseElement {
  DicomTag tag;
  const char* name;
  bool isTime = false;  ///< a time of day, which no message states
};
inline constexpr std::array<DicomPhaseElement, 6> kPhaseElements = {
    {{0x00200100, "temporal position (0020,0100)"},
     {0x00181060, "trigger time (0018,1060)"},
     {0x00200012, "acquisition number (0020,0012)"},
     {0x00180086, "echo number (0018,0086)"},
     {0x00080032, "acquisition time (0008,0032)", true},
     {0x00080033, "content time (0008,0033)", true}}};

struct DicomImage {
  InputFile file{""};
  std::string series, description;  ///< instance UID, text
  std::string modality;             ///< such as CT
  std::string transferSyntax;       ///< UID
  DicomPacking packing = DicomPacking::Native;
  std::size_t columns = 0, rows = 0, frames = 1, samples = 1;
  std::size_t bitsAllocated = 0, bitsStored = 0;
  bool isSigned = false;
  std::optional<std::array<double, 2>> padding;  ///< stored values that are no image, both ends
  std::string photometric;                       ///< interpretation, such as MONOCHROME2
  DicomPlane plane;                              ///< properties of all frames
  std::vector<DicomPlane> perFrame;  ///< properties of single frames, at least the first
  DicomElement pixels;
  std::array<std::string, kPhaseElements.size()> phases;  ///< values of these; empty: not stated

  [[nodiscard]] std::size_t frameBytes() const { return columns * rows * bitsAllocated / 8; }
};

/// Result of reading one file of a folder as a DICOM image.
struct DicomScan {
  InputFile file{""};
  std::string series;  ///< series that the file names, even if it is damaged further on
  std::optional<DicomImage>
      image;                   ///< empty without a fault: no image, such as a text or a DICOMDIR
  std::optional<Error> fault;  ///< why an image cannot be read; names the file
};

/// Reads all of `file` but its pixels. A fault is InvalidInput for a file that is damaged or whose
/// numbers describe no image, and Unsupported for features of DICOM that lumen does not read.
DicomScan scanDicom(const InputFile& file);

}  // namespace lumen::convert
