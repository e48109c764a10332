// SPDX-License-Identifier: Apache-2.0
// Recognition of a file by its first bytes, whatever its name, for messages about misplaced files.
#pragma once

#include <cstdint>
#include <string>

#include "converters/base/input_file.h"

namespace lumen::convert {

enum class ContentKind : std::uint8_t { Unknown, Volume, Seeds, Case, Mesh, Centerline, Other };

struct FileContent {
  ContentKind kind = ContentKind::Unknown;
  std::string name;      ///< "a volume (NRRD)", "seeds (3D Slicer Markups)", "a picture"
  std::string advice{};  ///< on a file that lumen does not read; maybe empty

  /// "this is a volume (NRRD)", "these are seeds".
  [[nodiscard]] std::string sentence() const;
};

/// Content of a file, by its beginning; Unknown for a folder, or a file that cannot be read or
/// recognised.
FileContent detectContent(const InputFile& file);

/// "this is a volume (NRRD), not a case; lumen convert and lumen track make a case of it". Empty if
/// the file has the expected kind, or its kind is unknown.
std::string notA(ContentKind wanted, const InputFile& file);

/// Whether the content is an image or a label map of DICOM.
bool isDicom(const FileContent& content);

/// Whether a file of VTK's legacy format holds lines and no surface. Reads all of it; false for a file
/// that cannot be read.
bool holdsLegacyLines(const InputFile& file);

}  // namespace lumen::convert
