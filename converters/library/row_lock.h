// SPDX-License-Identifier: Apache-2.0
// Turns of processes, perhaps on several machines, that make the same row of a list.
#pragma once

#include <filesystem>

#include "converters/base/progress.h"
#include "formats/case/file_descriptor.h"

namespace lumen::convert {

/// A lock on a row's folder for as long as this object lives, in a file beside the folder that is
/// open for writing, as file systems of clusters (NFS) demand. A file system without locks lets
/// everybody in.
class RowLock {
public:
  /// Waits for others. Throws Error(Failed) if the file cannot be made, Error(Cancelled).
  RowLock(const std::filesystem::path& folder, const Progress& progress);

  /// Whether a process makes the row of this folder now.
  static bool isHeld(const std::filesystem::path& folder);

private:
  formats::FileDescriptor m_file;
};

}  // namespace lumen::convert
