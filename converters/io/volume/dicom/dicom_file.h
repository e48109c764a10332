// SPDX-License-Identifier: Apache-2.0
// The beginning of a DICOM file, and its transfer syntax (DICOM PS3.10).
#pragma once

#include <cstdint>
#include <string>

#include "converters/io/volume/dicom/dicom_elements.h"

namespace lumen::convert {

// Storage classes.
inline constexpr const char* kDicomDirectory = "1.2.840.10008.1.3.10";
inline constexpr const char* kDicomStructures = "1.2.840.10008.5.1.4.1.1.481.3";
inline constexpr const char* kDicomSurfaces = "1.2.840.10008.5.1.4.1.1.66.5";

/// Packing of pixels.
enum class DicomPacking { Native, NativeBigEndian, Jpeg, JpegLs, Jpeg2000, RunLength };

struct DicomBeginning {
  bool isDicom = false;
  std::uint64_t at = 0;  ///< offset of the first element
  bool hasMeta = false;  ///< group 2 comes first
  bool hasMark = false;  ///< "DICM" at byte 128
  bool explicitVr = true;
};

/// Old writers omit the mark and the meta information: such a file begins with an element of group
/// 2 or 8, little-endian.
DicomBeginning readDicomBeginning(DicomBytes& bytes);

struct DicomMeta {
  std::string transferSyntax,
      storage;            ///< UIDs; a syntax is assumed where there is no meta information
  std::uint64_t end = 0;  ///< offset of the data set
};

/// Throws as walkDicom().
DicomMeta readDicomMeta(DicomBytes& bytes, const DicomBeginning& beginning);

struct DicomTransfer {
  const char* uid;
  DicomSyntax how;
  DicomPacking packing;
  bool isDeflated = false;
};

/// Throws Error(Unsupported), without the file's name, for a syntax that lumen does not read.
const DicomTransfer& findTransfer(const std::string& uid);

}  // namespace lumen::convert
