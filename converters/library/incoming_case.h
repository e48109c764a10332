// SPDX-License-Identifier: Apache-2.0
// A case on its way into a library.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "converters/library/record.h"
#include "formats/case/atomic_file.h"

namespace lumen::convert {

/// The files of a case, hidden beside the library until a change puts them in; they go with this
/// object if none does.
class IncomingCase {
public:
  /// Throws Error(Failed) if nothing can be written beside `library`, which need not exist.
  explicit IncomingCase(const std::filesystem::path& library);

  /// Writes a file and records it. `path` as record.files has it, not one that is there. `target`:
  /// of an export. Throws Error(InvalidInput) for a path that a library may not have, Error(Failed)
  /// if it cannot be written.
  void add(const std::string& path, const std::string& role, std::string_view bytes,
           const std::string& target = "");
  /// As add(), for a program.
  void addProgram(const std::string& path, const std::string& role, std::string_view bytes,
                  const std::string& target);
  /// Copies the file `source` into the case and records it. Throws Error(InvalidInput) for a path
  /// that a library may not have, Error(Failed) if it cannot be copied.
  void addFile(const std::string& path, const std::string& role,
               const std::filesystem::path& source);

  /// The record of the case. Its files are recorded by add(); version and date are the library's to
  /// set.
  CaseRecord record;

  /// The folder of the files.
  [[nodiscard]] std::filesystem::path folder() const { return m_workspace.path() / "case"; }

private:
  std::filesystem::path newPath(const std::string& path) const;
  void note(const std::string& path, const std::string& role, const std::string& target);

  formats::PendingFolder m_workspace;
};

/// Media type by the ending of a file's name; "application/octet-stream" for one that is not known.
std::string mediaType(const std::string& path);

}  // namespace lumen::convert
