// SPDX-License-Identifier: Apache-2.0
// Files that a page has dropped: bytes in memory.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "converters/base/input_file.h"

namespace lumen::viewer {

/// One file, or the files of a folder; they live as this object does.
class DroppedFiles {
public:
  DroppedFiles() = default;
  DroppedFiles(const DroppedFiles&) = delete;
  DroppedFiles& operator=(const DroppedFiles&) = delete;

  /// `name` is a label, of whose end messages have the harmless letters.
  void add(const std::string& name, std::string bytes);
  [[nodiscard]] const InputFile& first() const { return m_files.front(); }
  [[nodiscard]] InputFile folder() const { return {"dropped files", m_files}; }

private:
  std::deque<std::string> m_bytes;  ///< stay in their places
  std::vector<InputFile> m_files;
};

}  // namespace lumen::viewer
