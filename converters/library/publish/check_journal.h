// SPDX-License-Identifier: Apache-2.0
// Journal of the cases of a library that were found whole, so that an interrupted check goes on
// where it was.
//
// A case is passed over if nothing has touched its files since: for each the device, inode, size
// and the times of the last change of its bytes (mtime) and of anything of it (ctime), which no
// program can set back but by the machine's clock. A loss on the disk without a write is not seen;
// a file system that keeps no ctime is not to be trusted with it.
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
  /// Opens or makes the file. A journal of another version of lumen or of another library is not
  /// used, but begun anew. Throws Error(InvalidInput) for a file that is no journal, which stays as
  /// it is, and Error(Failed) if another check uses it.
  CheckJournal(const std::filesystem::path& file, const std::string& libraryId);

  [[nodiscard]] bool isUsed() const { return m_descriptor.isOpen(); }
  /// Whether the case was found whole when its files had this `mark`, a digest.
  [[nodiscard]] bool knows(const std::string& caseId, const std::string& mark) const;
  /// Adds a case that is whole. Throws Error(Failed).
  void add(const std::string& caseId, const std::string& mark);

private:
  void read(const std::string& text, const std::string& head);

  std::filesystem::path m_file;
  formats::FileDescriptor m_descriptor;
  std::unordered_map<std::string, std::string> m_marks;
};

}  // namespace lumen::convert
