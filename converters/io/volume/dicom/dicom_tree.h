// SPDX-License-Identifier: Apache-2.0
// Sequences of a DICOM file with their items: segments, surfaces, and contours.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/io/volume/dicom/dicom_values.h"

namespace lumen::convert {

struct DicomItem {
  DicomValues values;
  std::map<DicomTag, std::vector<DicomItem>> sequences;

  /// The items of a sequence; none if it is missing.
  [[nodiscard]] const std::vector<DicomItem>& items(DicomTag sequence) const;
  /// A text; empty if it is missing.
  [[nodiscard]] std::string text(DicomTag tag) const;
};

struct DicomTree {
  std::string storage;
  bool isDicom = false, isBigEndian = false;
  DicomItem top;  ///< short values, and the sequences that are wanted
};

/// The items of these sequences, with all values in them. Throws Error(InvalidInput) and
/// Error(Unsupported), naming the file, as scanDicom().
DicomTree readDicomTree(const InputFile& file, const std::vector<DicomTag>& sequences);

// Segments of a segmentation, and structures of a structure set.

struct DicomSegment {
  std::size_t number = 0;  ///< of the label; 0: none can be had
  std::string name;
  std::string type;  ///< meaning of its coded terminology; may be empty
};

inline constexpr std::size_t kMostLabel = 65535;  ///< of a volume of two bytes a voxel

/// The segments, or structures, that a file of DICOM names; none for other files, and for one that cannot
/// be read, which the reader of voxels refuses.
std::vector<DicomSegment> dicomSegments(const InputFile& file);

}  // namespace lumen::convert
