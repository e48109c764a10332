// SPDX-License-Identifier: Apache-2.0
// Files into the document.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "converters/base/progress.h"
#include "converters/engine/stage_options.h"
#include "viewer/session/document.h"
#include "viewer/session/dropped_files.h"

namespace lumen::viewer {

struct Opening {
  std::filesystem::path path;
  std::string label;                          ///< its name in messages
  bool dropped = false;                       ///< its bytes came from the page; `path` is temporary
  bool asTruth = false;                       ///< a case to compare with
  std::string series{};                       ///< instance UID, of a folder of DICOM
  std::shared_ptr<const DroppedFile> kept{};  ///< keeps a dropped folder while it is read
};

/// The role of the file, by its content and the ending of its name. Throws Error(Unsupported) for a
/// file that lumen does not read and Error(InvalidInput) for one that is not there.
FileRole openingRole(const Opening& opening);

/// The document with one more file, as number `id`. A volume, a case, a truth or seeds replace
/// those that were open; meshes are added. A case brings the seeds that it holds, beside those that
/// wait; a file of seeds leaves those that are tracked. A centerline becomes a case, and is fitted. Throws as
/// its reader.
Document withFile(const Document& document, const Opening& opening, int id,
                  const engine::VolumeArguments& volume, Progress& progress);

/// The document without that file and its part: with a case its tracked seeds go, with a file of
/// seeds those that wait. Throws Error(Usage) if there is none.
Document withoutFile(const Document& document, int id);

}  // namespace lumen::viewer
