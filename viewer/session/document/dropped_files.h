// SPDX-License-Identifier: Apache-2.0
// Files that came as bytes: dropped on the page, or made for a download.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "formats/case/atomic_file.h"

namespace lumen::viewer {

/// The end of `name` in harmless letters, with its ending, which names the format.
std::string harmlessName(const std::string& name);

/// A place for one file, in a private folder that is removed with this object.
class DroppedFile {
public:
  explicit DroppedFile(std::filesystem::path path) : m_path(std::move(path)) {}
  ~DroppedFile();
  DroppedFile(const DroppedFile&) = delete;
  DroppedFile& operator=(const DroppedFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return m_path; }

private:
  const std::filesystem::path m_path;
};

/// The places live in one temporary folder, which is made at the first of them and removed with
/// this object. All calls are thread-safe.
class DroppedFiles {
public:
  /// `name` is a label, of which only harmless letters are used. Throws Error(Failed) if there is
  /// no place.
  std::shared_ptr<const DroppedFile> placeFor(const std::string& name);
  /// The text without the path of the temporary folder.
  [[nodiscard]] std::string withoutFolder(std::string text) const;

private:
  mutable std::mutex m_mutex;  ///< guards the next two
  std::unique_ptr<formats::PendingFolder> m_folder;
  int m_last = 0;
};

}  // namespace lumen::viewer
