// SPDX-License-Identifier: Apache-2.0
// Files into the document.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "converters/base/progress.h"
#include "viewer/session/document/document.h"
#include "viewer/session/document/dropped_files.h"
#include "viewer/session/document/encoded_document.h"

namespace lumen::viewer {

/// The part that a file becomes, where its content leaves a choice.
enum class OpenAs : std::uint8_t {
  Auto,    ///< as its content is
  Truth,   ///< a case to compare with
  Second,  ///< a volume to look at beside the first
  Labels,  ///< a label map of the volume
};

struct Opening {
  InputFile file;     ///< in memory if it came from the page
  std::string label;  ///< its name in messages
  OpenAs as = OpenAs::Auto;
  std::string series{};                         ///< instance UID, of a folder of DICOM
  std::shared_ptr<const DroppedFiles> bytes{};  ///< of a file in memory
  /// The user begins with it, so that opening it cannot be undone.
  bool isFirst = false;
};

/// The role of the file, by its content and the ending of its name. Throws Error(Unsupported) for a
/// file that lumen does not read, Error(InvalidInput) for one that is not there, and Error(Usage)
/// for one that is not what it should be opened as.
FileRole openingRole(const Opening& opening);

/// The document with one more file, as number `id`. A volume, a second volume, a case, a truth or
/// seeds replace those that were open; meshes are added. A second volume is read without options
/// but for the files that a header may name, and needs a first: Error(Usage). So does a label map,
/// whose names and roles the options state if it was named by a person. A case brings the seeds that it holds, beside those that
/// wait; a file of seeds leaves those that are tracked. A centerline becomes a case, and is fitted. Throws as
/// its reader.
Document withFile(const Document& document, const Opening& opening, int id,
                  const SessionOptions& options, Progress& progress);

/// The document without that file and its part: with a volume the second and the labels go, with a case its
/// tracked seeds, with a file of seeds those that wait. Throws Error(Usage) if there is none.
Document withoutFile(const Document& document, int id);

}  // namespace lumen::viewer
