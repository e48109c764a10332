// SPDX-License-Identifier: Apache-2.0
// Work that is not saved, on disk beside the file that it would be saved in: it survives the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viewer/session/document.h"

namespace lumen::viewer {

/// Files that hold what an earlier program did not save of `file`: `head.unsaved.lumen`,
/// `head.unsaved.seeds.json`, `head.unsaved.2.lumen`, sorted by name.
std::vector<std::filesystem::path> unsavedOf(const std::filesystem::path& file);

/// Writes them for one session. Files that were there before are never touched: the first name that
/// is free is taken, and kept. Not thread-safe.
class UnsavedFiles {
public:
  /// From now on beside this file; what was written beside another stays there.
  void beside(const std::filesystem::path& file);
  /// Writes, atomically, what is new of the case and the seeds; null for what is saved, whose file
  /// is removed. Throws what writers throw.
  void write(const std::shared_ptr<const formats::Case>& value,
             const std::shared_ptr<const Seeds>& seeds);
  /// What there is.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

private:
  [[nodiscard]] std::filesystem::path freeName(const std::string& ending) const;

  std::filesystem::path m_beside, m_caseFile, m_seedsFile;
  std::shared_ptr<const formats::Case> m_value;
  std::shared_ptr<const Seeds> m_seeds;
};

}  // namespace lumen::viewer
