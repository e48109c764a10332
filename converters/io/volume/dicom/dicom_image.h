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
#include "converters/io/volume/dicom/dicom_file.h"
#include "converters/io/volume/dicom/dicom_values.h"

namespace lumen::convert {

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
  DicomType type = DicomType::Text;
  bool isTime = false;  ///< a time of day, which no message states
};
inline constexpr std::array<DicomPhaseElement, 15> kPhaseElements = {
    {{0x00209056, "stack ID (0020,9056)"},
     {0x00200100, "temporal position (0020,0100)"},
     {0x00209128, "temporal position index (0020,9128)", DicomType::Whole},
     {0x0020930d, "temporal position's time (0020,930d)", DicomType::Float},
     {0x00181060, "trigger time (0018,1060)"},
     {0x00209153, "delay after the trigger (0020,9153)", DicomType::Float},
     {0x00200012, "acquisition number (0020,0012)"},
     {0x00209156, "frame's acquisition number (0020,9156)", DicomType::Whole},
     {0x00180086, "echo number (0018,0086)"},
     {0x00189082, "echo time (0018,9082)", DicomType::Float},
     {0x00189087, "b-value (0018,9087)", DicomType::Float},
     {0x00080008, "image type (0008,0008)"},
     {0x00089007, "frame type (0008,9007)"},
     {0x00080032, "acquisition time (0008,0032)", DicomType::Text, true},
     {0x00080033, "content time (0008,0033)", DicomType::Text, true}}};
using DicomPhases = std::array<std::string, kPhaseElements.size()>;

/// Segmentations: each frame shows one segment, by bits or by shares of the whole, or all by numbers.
enum class DicomLabels { None, Binary, Fractional, Map };

struct DicomImage {
  InputFile file{""};
  std::string series, description;  ///< instance UID, text
  std::string modality;             ///< such as CT
  std::string transferSyntax;       ///< UID
  DicomPacking packing = DicomPacking::Native;
  std::size_t columns = 0, rows = 0, frames = 1, samples = 1;
  std::size_t bitsAllocated = 0, bitsStored = 0, highBit = 0;
  bool isSigned = false;
  std::optional<std::array<double, 2>> padding;  ///< stored values that are no image, both ends
  std::string photometric;                       ///< interpretation, such as MONOCHROME2
  DicomPlane plane;                              ///< properties of all frames
  std::vector<DicomPlane> perFrame;  ///< properties of single frames, at least the first
  DicomElement pixels;
  std::optional<std::uint64_t> deflatedFrom;  ///< DicomBytes::inflateFrom()
  DicomPhases phases;                         ///< values of the elements; empty: not stated
  std::vector<DicomPhases> framePhases;       ///< for each of `perFrame`
  std::vector<std::size_t> chosen;            ///< frames of a volume among several; empty: all
  DicomLabels labels = DicomLabels::None;
  std::size_t mostFraction = 1;            ///< stored value of the whole in a share
  std::size_t segment = 0;                 ///< number of the segment of all frames
  std::vector<std::size_t> frameSegments;  ///< for each of `perFrame`

  /// Bytes of one frame; bits of several frames follow one another without a gap.
  [[nodiscard]] std::size_t frameBytes() const { return (columns * rows * bitsAllocated + 7) / 8; }
  [[nodiscard]] std::size_t pixelBytes() const {
    return bitsAllocated == 1 ? (columns * rows * frames + 7) / 8 : frameBytes() * frames;
  }
  [[nodiscard]] const DicomPlane& planeOf(std::size_t frame) const {
    return perFrame.empty() ? plane : perFrame[frame];
  }
  [[nodiscard]] const DicomPhases& phasesOf(std::size_t frame) const {
    return framePhases.empty() ? phases : framePhases[frame];
  }
  [[nodiscard]] std::size_t segmentOf(std::size_t frame) const {
    return frameSegments.empty() ? segment : frameSegments[frame];
  }
  /// The frames of the volume.
  [[nodiscard]] std::vector<std::size_t> usedFrames() const {
    if (!chosen.empty()) return chosen;
    std::vector<std::size_t> all(frames);
    for (std::size_t n = 0; n < frames; ++n) all[n] = n;
    return all;
  }
};

/// Result of reading one file of a folder as a DICOM image.
struct DicomScan {
  InputFile file{""};
  std::string series;   ///< series that the file names, even if it is damaged further on
  std::string storage;  ///< UID of the storage class
  std::optional<DicomImage>
      image;                   ///< empty without a fault: no image, such as a text or a DICOMDIR
  std::optional<Error> fault;  ///< why an image cannot be read; names the file
};

/// Reads all of `file` but its pixels. A fault is InvalidInput for a file that is damaged or whose
/// numbers describe no image, and Unsupported for features of DICOM that lumen does not read.
DicomScan scanDicom(const InputFile& file);

}  // namespace lumen::convert
