// SPDX-License-Identifier: Apache-2.0
// Turns of programs that read and programs that change a library, and of those that make the same
// row of a list.
#pragma once

#include <cstdint>
#include <filesystem>

#include "converters/base/progress.h"
#include "formats/case/file_descriptor.h"

namespace lumen::convert {

/// The folder of a library, through a link if there is one. Throws Error(InvalidInput) if no such
/// folder exists or it cannot be read.
formats::FileDescriptor openLibraryFolder(const std::filesystem::path& library);

/// A lock on a library: on its folder, so that nothing of it is left behind. A program that opens
/// the library again under its name may find another folder there. A file system without locks has
/// no other users either.
class LibraryLock {
public:
  enum class Use : std::uint8_t {
    Read,
    Change
  };  ///< readers share a lock, a change excludes all others

  /// Waits for others, and reports that to `progress`. Throws as openLibraryFolder(), and
  /// Error(Cancelled).
  LibraryLock(const std::filesystem::path& library, Progress& progress, Use use = Use::Change);

private:
  formats::FileDescriptor m_folder;
};

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
