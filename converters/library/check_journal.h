// SPDX-License-Identifier: Apache-2.0
// Which cases of a library were found whole, so that a check that was interrupted goes on where it was.
//
// A case is passed over if nothing has touched its files since: for each the device, inode, size and the times of the last
// change of its bytes (mtime) and of anything of it (ctime), which no program can set back but by the machine's clock.
// What a disk has lost without being written to is not seen; a file system that keeps no ctime is not to be trusted with it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <unordered_map>

#include "formats/case/file_descriptor.h"

namespace lumen::convert {

class CheckJournal {
public:
  /// None: nothing is known, nothing kept.
  CheckJournal() = default;
  /// Opens or makes the file. What another version of lumen or another library wrote is not used, but begun anew. Throws
  /// Error(InvalidInput) for a file that is no journal, which stays as it is, and Error(Failed) if another check uses it.
  CheckJournal(const std::filesystem::path& file, const std::string& libraryId);

  [[nodiscard]] bool isUsed() const { return m_descriptor.isOpen(); }
  /// Whether the case was found whole when `mark`, a digest, told of its files.
  [[nodiscard]] bool knows(const std::string& caseId, const std::string& mark) const;
  /// Keeps it. Throws Error(Failed).
  void add(const std::string& caseId, const std::string& mark);

private:
  void read(const std::string& text, const std::string& head);

  std::filesystem::path m_file;
  formats::FileDescriptor m_descriptor;
  std::unordered_map<std::string, std::string> m_marks;
};

}  // namespace lumen::convert
